// Borders of the range window, and symmetry.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

bool empty(const Ping& ping) { return sum_of(ping.echo.direct) == 0.0; }

// Footprints of hits reach a little beyond the hit, so these walls stand a metre and more beyond the window.
TEST(Window, NothingBeyondRangeMaxAppears) {
  const SonarModel sonar = bare_sonar();
  for (const double distance : {10.5, 11.0, 12.5, 19.5, 20.5, 30.0, 95.0}) {
    const Ping ping = ping_of(scene_of({wall_mesh({distance, 0, 0}, {-1, 0, 0}, 200.0)}), sonar);
    EXPECT_TRUE(empty(ping)) << distance;
    for (const float r : ping.truth.first_hit_range_m.pixels()) ASSERT_TRUE(std::isinf(r));
    for (const int start : ping.truth.shadow_start_bin) EXPECT_EQ(start, sonar.geometry.range_bins);
  }
}

TEST(Window, WallAcrossRangeMaxFillsTheLastBinsOnly) {
  const SonarModel sonar = bare_sonar();
  const Ping ping = ping_of(scene_of({wall_mesh({9.99, 0, 0}, {-1, 0, 0})}), sonar);
  const int first = *sonar.geometry.bin_of(9.99);
  EXPECT_EQ(first, sonar.geometry.range_bins - 1);
  for (int bin = 0; bin < first; ++bin) {
    for (int beam = 0; beam < sonar.geometry.beams(); ++beam) ASSERT_EQ(ping.echo.direct(bin, beam), 0.0F) << bin;
  }
  EXPECT_GT(ping.echo.direct(first, 64), 0.0F);
}

// A near object stops the rays whether its own echo is in the window or not.
TEST(Window, NearerThanRangeMinOccludes) {
  const SonarModel sonar = bare_sonar();
  const TriangleMesh near_plate = plate_mesh({0.3, 0, 0}, {0, 1.0, 0}, {0, 0, 1.0});
  const Ping ping = ping_of(scene_of({near_plate, wall_mesh({4.0, 0, 0}, {-1, 0, 0})}), sonar);
  EXPECT_TRUE(empty(ping));
  for (const int start : ping.truth.shadow_start_bin) EXPECT_EQ(start, 0);
}

TEST(Window, EmptyWaterGivesNothing) {
  Scene scene = scene_of({});
  const Ping ping = ping_of(scene, bare_sonar(), Pose::Identity(), true);
  EXPECT_TRUE(empty(ping));
  for (const std::int32_t i : ping.truth.instance.pixels()) ASSERT_EQ(i, -1);
}

// Mirror image: neighbouring columns place their rays at other heights within a step, mirrored ones at the opposite
// height, therefore not the same bits. The arc of a column is shifted by up to 0.375 steps of 20 / 1024 deg, that of
// its mirror image the other way. On the floor d E / d phi goes as phi^3, so E as phi^4, and a beam differs by up to
// 4 * 0.75 * (20 / 1024) / 10 = 0.6 %. A cell of any weight (1e-3 of the largest): 3 %.
TEST(Symmetry, MirroredSceneGivesTheMirroredImage) {
  const SonarModel sonar = bare_sonar({.beams = 128, .azimuth_fov_deg = 60.0, .elevation_rays = 1024});
  const Scene scene = scene_of({floor_mesh(-1.0), moved(sphere_mesh(1.5, 720, 360), {6.0, 0, 0})});
  const Image2<float> echo = ping_of(scene, sonar).echo.direct;
  const double largest = static_cast<double>(*std::max_element(echo.pixels().begin(), echo.pixels().end()));
  double worst_cell = 0;
  for (int beam = 0; beam < 64; ++beam) {
    EXPECT_NEAR(beam_sum(echo, beam) / beam_sum(echo, 127 - beam), 1.0, 0.006) << beam;
    for (int bin = 0; bin < echo.rows(); ++bin) {
      const auto port = static_cast<double>(echo(bin, beam));
      const auto starboard = static_cast<double>(echo(bin, 127 - beam));
      if (port + starboard < 2e-3 * largest) continue;
      worst_cell = std::max(worst_cell, std::abs(port - starboard) / (port + starboard) * 2.0);
    }
  }
  std::printf("worst cell of the mirror image: %.2f %%\n", 100 * worst_cell);
  EXPECT_LT(worst_cell, 0.03);
}

// Turning sonar and scene together by yaw changes nothing but float rounding.
TEST(Symmetry, MovedTogether) {
  const SonarModel sonar = bare_sonar({.elevation_rays = 512});
  const Ping still = ping_of(scene_of({floor_mesh(-1.0), wall_mesh({6.0, 0, 0}, {-1, 0.2, 0})}), sonar);
  const Pose turned = pose_from_xyz_rpy({10.0, -7.0, -3.0}, 0, 0, radians(77.0));
  const Ping moved_ping =
      ping_of(scene_of({floor_mesh(-4.0), wall_mesh(turned * Vec3(6.0, 0, 0), turned.linear() * Vec3(-1, 0.2, 0))}),
              sonar, turned);
  for (int beam = 0; beam < sonar.geometry.beams(); ++beam) {
    EXPECT_NEAR(beam_sum(moved_ping.echo.direct, beam) / beam_sum(still.echo.direct, beam), 1.0, 1e-3);
  }
}

}  // namespace
}  // namespace ensonify
