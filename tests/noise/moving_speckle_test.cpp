// How speckle follows a sonar that moves over a rough plane. Correlations of intensity over some 20000 independent
// pixels: standard error 0.007.
#include <gtest/gtest.h>

#include "ensonify/noise/disturb_echo.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"
#include "support/statistics.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double bin_m = 0.002842;
constexpr double height_m = 0.4;

SonarModel instrument() {
  SonarModel sonar =
      bare_sonar({.elevation_fov_deg = 40, .range_min_m = 0.8, .range_max_m = 0.8 + 400 * bin_m, .bins = 400});
  sonar.geometry.beam_azimuth_rad = uniform_sine_beams(256, radians(60.0));
  sonar.elevation = Aperture(Shading::box, sonar.geometry.elevation_fov_rad);
  return sonar;
}

/// Intensity over a floor, over its mean power, as a sonar at `offset` sees it with the given yaw.
std::vector<double> speckle_at(const Vec3& offset, double yaw_rad = 0.0) {
  const SonarModel sonar = instrument();
  const Scene scene = scene_of({floor_mesh(-height_m)});
  const RayScene rays(scene);
  const Pose T_world_sonar = pose_from_xyz_rpy(offset, 0.0, radians(20.0), yaw_rad);
  const Echo echo = PingTracer(rays, sonar, scene.water).trace(T_world_sonar, {.elevation = true}).echo;
  const RandomKey key = RandomKey::from_seed(2024);
  const Receiver receiver(sonar);
  const auto received = disturb_echo({"test", {CoherentSpeckle<double>{}}}, echo, receiver,
                                     {T_world_sonar, key.child("surface"), {}, {}});
  const Image2<float> mean = receiver.spread.apply(echo.direct);
  std::vector<double> x;
  for (int bin = 20; bin < 380; ++bin) {
    for (int b = 20; b < 236; ++b) x.push_back(static_cast<double>(received.power(bin, b) / mean(bin, b)));
  }
  return x;
}

// Resolution cell at 1.4 m, middle of the image: a bin of 2.84 mm in range, 0.4 degrees = 9.8 mm across.
constexpr double cell_across_m = 1.4 * 0.4 * 3.14159 / 180.0;

TEST(MovingSonar, TwoCellsAwaySpeckleIsNew) {
  const auto here = speckle_at({0, 0, 0});
  EXPECT_EQ(here, speckle_at({0, 0, 0}));
  EXPECT_LT(correlation_of(here, speckle_at({0, 2 * cell_across_m, 0})), 0.2);
  EXPECT_LT(correlation_of(here, speckle_at({2 * bin_m, 0, 0})), 0.2);
  EXPECT_LT(correlation_of(here, speckle_at({0, 0, 0}, 2 * radians(0.4))), 0.2);
}

// A tenth of a cell changes little: speckle neither boils nor sticks to the pixels.
TEST(MovingSonar, ATenthOfACellChangesLittle) {
  const auto here = speckle_at({0, 0, 0});
  EXPECT_GT(correlation_of(here, speckle_at({0, 0.1 * cell_across_m, 0})), 0.6);
  EXPECT_GT(correlation_of(here, speckle_at({0.1 * bin_m, 0, 0})), 0.6);
  EXPECT_GT(correlation_of(here, speckle_at({0, 0, 0}, radians(0.04))), 0.6);
}

// It stays on the surface: after a turn by whole beams in the middle of the fan, the image is the old one, shifted.
// (Uniform in sine: the beams are 0.2246 degrees apart there.)
TEST(MovingSonar, SpeckleStaysOnTheSurface) {
  const auto here = speckle_at({0, 0, 0});
  const auto turned = speckle_at({0, 0, 0}, radians(4 * 0.2246));
  std::vector<double> a, b;
  constexpr int columns = 216;
  for (int bin = 0; bin < 360; ++bin) {
    for (int beam = 90; beam < 120; ++beam) {
      a.push_back(here[static_cast<std::size_t>(bin * columns + beam)]);
      b.push_back(turned[static_cast<std::size_t>(bin * columns + beam + 4)]);
    }
  }
  EXPECT_GT(correlation_of(a, b), 0.5);
}

}  // namespace
}  // namespace ensonify
