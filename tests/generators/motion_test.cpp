#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/random_pose.hpp"
#include "ensonify/generators/waypoint_path.hpp"
#include "ensonify/sim/voxelize.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

const Drift paper{1.1, 1200.0};

RandomKey seed(std::uint64_t s) { return RandomKey::from_seed(s).child("drift"); }

// 1000 seeds: mean radius 1.1 m; of a Rayleigh radius the standard deviation is 0.523 of the mean, so 1.65 % of
// standard error: 5 % is 3 of them. Axes: equal variance (standard error sqrt(2 / n) = 4.5 %), uncorrelated (1 / sqrt
// n).
TEST(Drift, MeanRadiusAfterTwentyMinutes) {
  double radius = 0, xx = 0, yy = 0, xy = 0;
  for (std::uint64_t s = 0; s < 1000; ++s) {
    const Eigen::Vector2d e = drift_m(paper, seed(s), 1200.0);
    radius += e.norm() / 1000;
    xx += e.x() * e.x() / 1000;
    yy += e.y() * e.y() / 1000;
    xy += e.x() * e.y() / 1000;
  }
  std::printf("mean radius %.3f m\n", radius);
  EXPECT_NEAR(radius, 1.1, 0.055);
  EXPECT_NEAR(xx / yy, 1.0, 4 * 0.045 * std::sqrt(2.0));
  EXPECT_LT(std::abs(xy) / std::sqrt(xx * yy), 4 / std::sqrt(1000.0));
}

// Half of the variance is a bias, growing as t^2, half a walk, growing as t: at t = T / 4 it is sigma^2 (1/16 + 1/4) /
// 2 a share of 0.15625.
TEST(Drift, VarianceGrowsWithTime) {
  double quarter = 0, whole = 0;
  for (std::uint64_t s = 0; s < 2000; ++s) {
    quarter += drift_m(paper, seed(s), 300.0).squaredNorm();
    whole += drift_m(paper, seed(s), 1200.0).squaredNorm();
  }
  EXPECT_NEAR(quarter / whole, 0.15625, 0.02);
}

TEST(Drift, StartsAtZeroAndIsContinuous) {
  for (std::uint64_t s = 0; s < 20; ++s) {
    EXPECT_NEAR(drift_m(paper, seed(s), 0.0).norm(), 0.0, 1e-12);
    // A walk of 1.1 m in 1200 s steps by about 0.62 sqrt(dt / 1200) an axis: 6 sigma of 0.01 s is 1.1 cm.
    for (double t = 0; t < 60.0; t += 0.01) {
      const double step = (drift_m(paper, seed(s), t + 0.01) - drift_m(paper, seed(s), t)).norm();
      ASSERT_LT(step, 0.04) << t;
    }
    for (const double t : {0.125, 1.0, 600.0, 1200.0, 65536.0}) {  // borders of the construction
      const double jump = (drift_m(paper, seed(s), t + 1e-9) - drift_m(paper, seed(s), t - 1e-9)).norm();
      EXPECT_LT(jump, 1e-6) << t;
    }
  }
}

TEST(Drift, AnyTimeAlone) {
  const Eigen::Vector2d late_first = drift_m(paper, seed(3), 900.0);
  drift_m(paper, seed(3), 10.0);
  drift_m(paper, seed(4), 900.0);
  EXPECT_EQ(drift_m(paper, seed(3), 900.0), late_first);
  const Pose pose = pose_from_xyz_rpy({1, 2, -3}, 0.1, 0.2, 0.3);
  const Pose estimate = drifted(pose, paper, seed(3), 900.0);
  EXPECT_EQ(estimate.linear(), pose.linear());
  EXPECT_EQ(estimate.translation().z(), -3.0);
  EXPECT_TRUE((estimate.translation() - pose.translation()).head<2>().isApprox(late_first, 1e-12));
}

std::vector<Pose> corner() {
  return {pose_from_xyz_rpy({0, 0, -1}, 0, 0, 0), pose_from_xyz_rpy({4, 0, -1}, 0, 0, radians(90)),
          pose_from_xyz_rpy({4, 3, -1}, 0, 0, radians(170))};
}

// Length 4 + 3; at s the pose has gone s; back on the same way, period 14.
TEST(WaypointPath, SpeedAndPingPong) {
  const WaypointPath path(corner());
  EXPECT_DOUBLE_EQ(path.length_m(), 7.0);
  for (double s = 0; s < 28.0; s += 0.05) {
    const Pose here = path.at(s);
    const Pose next = path.at(s + 0.001);
    EXPECT_LE((next.translation() - here.translation()).norm(), 0.001 + 1e-12);
    EXPECT_TRUE(here.isApprox(path.at(s + 14.0), 1e-9)) << s;
    EXPECT_TRUE(here.isApprox(path.at(std::abs(14.0 - std::fmod(s, 14.0))), 1e-9)) << s;
    EXPECT_NEAR(here.linear().determinant(), 1.0, 1e-12);
  }
  EXPECT_TRUE(path.at(5.5).translation().isApprox(Vec3(4, 1.5, -1), 1e-12));
  EXPECT_NEAR(roll_pitch_yaw(path.at(2.0))[2], radians(45.0), 1e-12);
  EXPECT_NEAR(roll_pitch_yaw(path.at(5.5))[2], radians(130.0), 1e-12);
  EXPECT_NEAR((path.at(3.0).translation() - path.at(1.0).translation()).norm(), 2.0, 1e-12);
}

TEST(WaypointPath, NeedsAWay) {
  EXPECT_THROW(WaypointPath({}), ConfigError);
  EXPECT_THROW(WaypointPath({Pose::Identity()}), ConfigError);
  EXPECT_THROW(WaypointPath({Pose::Identity(), Pose::Identity()}), ConfigError);
  auto stop = corner();
  stop.insert(stop.begin() + 1, stop[1]);  // a stop on the way is no division by zero
  stop.insert(stop.begin() + 1, stop[0]);
  const WaypointPath path(stop);
  for (double s = 0; s < 14.0; s += 0.1) ASSERT_TRUE(path.at(s).matrix().allFinite()) << s;
}

/// A box of 1 m in the middle of 6 x 6 x 4 m of water over a floor.
Place place_with_a_box() {
  Scene scene =
      test::scene_of({test::box_mesh({-0.5F, -0.5F, -2.5F}, {0.5F, 0.5F, -1.5F}), test::floor_mesh(-4.05, 5.0)});
  scene.bounds_m = {Vec3(-4, -4, -4.2), Vec3(4, 4, 0)};
  scene.navigable_m = {Vec3(-3, -3, -3.5), Vec3(3, 3, -0.5)};
  RayScene rays(scene);
  OccupancyGrid truth = voxelize(scene, 0.1).grid;
  return {std::move(scene), std::move(rays), std::move(truth)};
}

TEST(RandomPose, KeepsClearanceAndSeesEnough) {
  const Place place = place_with_a_box();
  const SonarModel sonar = test::bare_sonar();
  RandomPoses poses;
  poses.clearance_m = 0.4;
  poses.least_seen_share = 0.3;
  poses.pitch_deg = Uniform{0, 30};
  poses.tries = 500;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto pose = sample_pose(poses, place, sonar.geometry, RandomKey::from_seed(i));
    ASSERT_TRUE(pose.has_value()) << i;
    const Vec3 p = pose->T_world_sonar.translation();
    EXPECT_TRUE(place.scene.navigable_m.contains(p));
    const Vec3 beyond = ((p - Vec3(0, 0, -2)).cwiseAbs() - Vec3::Constant(0.5)).cwiseMax(0.0);
    EXPECT_GT(beyond.norm(), 0.4);
    EXPECT_GE(pose->tries, 1);
    EXPECT_LE(pose->tries, 500);
    const double pitch = degrees(roll_pitch_yaw(pose->T_world_sonar)[1]);
    EXPECT_GE(pitch, -1e-9);
    EXPECT_LE(pitch, 30 + 1e-9);
    EXPECT_TRUE(sample_pose(poses, place, sonar.geometry, RandomKey::from_seed(i))
                    ->T_world_sonar.isApprox(pose->T_world_sonar, 0.0));
  }
}

TEST(RandomPose, GivesUpAfterItsTries) {
  const Place place = place_with_a_box();
  RandomPoses poses;
  poses.tries = 20;
  poses.clearance_m = 5.0;  // nowhere
  EXPECT_FALSE(sample_pose(poses, place, test::bare_sonar().geometry, RandomKey::from_seed(1)).has_value());
  poses.clearance_m = 0.1;
  poses.pitch_deg = Constant{-80};  // looks up into nothing
  EXPECT_FALSE(sample_pose(poses, place, test::bare_sonar().geometry, RandomKey::from_seed(1)).has_value());
}

}  // namespace
}  // namespace ensonify
