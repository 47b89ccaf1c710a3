#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/random_pose.hpp"
#include "ensonify/sim/voxelize.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

const Drift paper{1.1, 1200.0};

RandomKey seed(std::uint64_t s) { return RandomKey::from_seed(s).child("drift"); }

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
