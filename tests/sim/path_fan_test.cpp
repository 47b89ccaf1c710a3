// Where rays leave the fan for good.
#include "ensonify/sim/path_fan.hpp"

#include <gtest/gtest.h>

#include "ensonify/core/random.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

// Places at 1 to 5 m within the fan and directions all over the sphere. What lies within the fan 2 cm before the limit
// or nearer is not asked for: rays end a little beyond it.
TEST(PathFan, NothingOfTheFanLiesBeyondTheLimitOfARay) {
  for (const double azimuth_fov_deg : {60.0, 130.0, 200.0}) {
    SCOPED_TRACE(azimuth_fov_deg);
    const SonarModel sonar =
        bare_sonar({.beams = 100, .azimuth_fov_deg = azimuth_fov_deg, .elevation_fov_deg = 40.0, .bins = 100});
    const PathFan fan(sonar, RayFan(sonar), 64);
    RandomSequence random(RandomKey{7});
    int limited = 0;
    int came_back = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto share = [&] { return static_cast<float>(random.uniform(0.001, 0.999)); };
      const Eigen::Vector3f place = static_cast<float>(random.uniform(1.0, 5.0)) * fan.direction(share(), share());
      Eigen::Vector3f unit(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                           static_cast<float>(random.normal()));
      unit.normalize();
      const float limit = fan.distance_within(place, unit);
      bool outside = false;
      for (float t = 0.0f; t < 12.0f; t += 0.02f) {
        const bool within = fan.place_of((place + t * unit).normalized()).column >= 0;
        ASSERT_FALSE(within && t > limit + 0.02f) << "limit " << limit << ", within the fan at " << t;
        came_back += within && outside;
        outside = !within;
      }
      limited += limit < 12.0f;
    }
    EXPECT_GT(limited, 3000);
    EXPECT_GT(came_back, 10);
  }
}

}  // namespace
}  // namespace ensonify
