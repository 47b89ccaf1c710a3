// Shadows by similar triangles, against the echo-free bins and against PingTruth::shadow_start_bin.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

// Sonar at height H over a floor, box of height h < H whose far top edge is at ground distance rho. The ray over that
// edge meets the floor at rho H / (H - h), so the shadow is h rho / (H - h) long. The last echo of the box comes from
// its edge at sqrt(rho^2 + (H - h)^2), the first one of the floor behind from sqrt((rho H / (H - h))^2 + H^2).
// The floor before the box, whose front stands at rho - 0.5, echoes up to sqrt((rho - 0.5)^2 + H^2).
TEST(Shadow, LengthBehindABoxOnTheFloor) {
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 100.0, .elevation_rays = 4096});
  const double H = 1.5;
  for (const double h : {0.3, 0.6, 0.9}) {
    for (const double rho : {2.0, 3.0}) {
      const float low = static_cast<float>(-H - 0.5);
      const TriangleMesh box = box_mesh({static_cast<float>(rho - 0.5), -2.0F, low},
                                        {static_cast<float>(rho), 2.0F, static_cast<float>(h - H)});
      const Ping ping = ping_of(scene_of({floor_mesh(-H), box}), sonar);
      const double end = rho * H / (H - h);
      ASSERT_NEAR(end - rho, h * rho / (H - h), 1e-12);
      const double last_m = std::max(std::hypot(rho, H - h), std::hypot(rho - 0.5, H));
      const double first_m = std::hypot(end, H);
      const int last = *sonar.geometry.bin_of(last_m);
      const int first = *sonar.geometry.bin_of(first_m);
      const int beam = 64;
      EXPECT_GT(ping.echo.direct(last - 1, beam), 0.0F);
      for (int bin = last + 2; bin < first - 1; ++bin) ASSERT_EQ(ping.echo.direct(bin, beam), 0.0F) << bin;
      EXPECT_GT(ping.echo.direct(first + 1, beam), 0.0F) << "h " << h << " rho " << rho;
    }
  }
}

// The elevation arc of a beam is its nominal field of view, -F/2 .. F/2; the shadow starts at the first bin before
// which half of it is occluded. A wall at D, facing: the ray at phi ends at D / cos phi, so half have ended at
// phi = F / 4.
TEST(Shadow, StartsWhereAWallHasTakenHalfOfTheArc) {
  for (const double fov_deg : {12.0, 30.0, 60.0}) {
    for (const Shading shading : {Shading::box, Shading::hann}) {
      const SonarModel sonar = bare_sonar({.elevation_fov_deg = fov_deg, .elevation = shading, .elevation_rays = 4096});
      const Ping ping = ping_of(scene_of({wall_mesh({4.0, 0, 0}, {-1, 0, 0})}), sonar);
      const double half_taken = 4.0 / std::cos(radians(fov_deg / 4.0));
      EXPECT_NEAR(ping.truth.shadow_start_bin[64], *sonar.geometry.bin_of(half_taken) + 1, 1) << fov_deg;
    }
  }
}

// Nose down by p over a floor at height H: the ray at phi meets it at H / sin(p - phi), so the middle ray ends at
// H / sin p. Without pitch the upper half of the arc never ends: no shadow at all.
TEST(Shadow, FloorUnderAPitchedSonar) {
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 20.0, .elevation_rays = 4096});
  const Scene scene = scene_of({floor_mesh(-1.5)});
  for (const double pitch_deg : {12.0, 20.0, 40.0}) {
    const Ping ping = ping_of(scene, sonar, pose_from_xyz_rpy(Vec3::Zero(), 0, radians(pitch_deg), 0));
    const double middle = 1.5 / std::sin(radians(pitch_deg));
    EXPECT_NEAR(ping.truth.shadow_start_bin[64], *sonar.geometry.bin_of(middle) + 1, 1) << pitch_deg;
  }
  const Ping level = ping_of(scene, sonar, pose_from_xyz_rpy(Vec3::Zero(), 0, radians(-0.5), 0));
  for (const int start : level.truth.shadow_start_bin) EXPECT_EQ(start, sonar.geometry.range_bins);
}

// Sixteen rays over the lobe of a uniform aperture that is 2 deg wide stand further apart than its field of view is
// high: the ray nearest to the axis stands for the arc. In open water it ends nowhere, a wall takes it.
TEST(Shadow, OfAnArcThatFallsBetweenTheRays) {
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 2.0, .elevation = Shading::uniform, .elevation_rays = 16});
  const Scene far_below = scene_of({floor_mesh(-500)});
  for (const int start : ping_of(far_below, sonar).truth.shadow_start_bin) EXPECT_EQ(start, sonar.geometry.range_bins);
  const Ping before_wall = ping_of(scene_of({wall_mesh({4.0, 0, 0}, {-1, 0, 0})}), sonar);
  EXPECT_NEAR(before_wall.truth.shadow_start_bin[64], *sonar.geometry.bin_of(4.0) + 1, 1);
}

// A plate over the lower 40 % of the arc throws no shadow by the rule of the half, one over 60 % does.
TEST(Shadow, NeedsHalfOfTheArc) {
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 20.0, .elevation_rays = 1024});
  for (const double share : {0.4, 0.6}) {
    const double top = 3.0 * std::tan(radians(20.0 * share - 10.0));
    const Scene scene = scene_of({plate_mesh({3.0, 0, top - 1.0}, {0, 2.0, 0}, {0, 0, 1.0})});
    const int start = ping_of(scene, sonar).truth.shadow_start_bin[64];
    if (share < 0.5) {
      EXPECT_EQ(start, sonar.geometry.range_bins);
    } else {
      EXPECT_NEAR(start, *sonar.geometry.bin_of(3.0 / std::cos(radians(10.0))), 4);
    }
  }
}

}  // namespace
}  // namespace ensonify
