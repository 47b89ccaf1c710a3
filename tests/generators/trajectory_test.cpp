#include "ensonify/generators/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/lawnmower.hpp"
#include "ensonify/generators/object_outline.hpp"
#include "ensonify/sim/probe.hpp"
#include "ensonify/sim/voxelize.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

constexpr double pi = std::numbers::pi;

/// 16 x 12 x 5 m of water; a block of 3 x 2 m that stands askew, and a wall along the north.
Scene harbour() {
  Scene scene = test::scene_of({test::box_mesh({-1.5F, -1, -1.5F}, {1.5F, 1, 1.5F}),
                                test::box_mesh({-9, 6, -5}, {9, 7, 0}), test::floor_mesh(-5.05, 10.0)});
  scene.name = "harbour";
  scene.instances[0].name = "block";
  scene.instances[0].T_world_object = Eigen::Translation3d(1, 0, -2.5) * Eigen::AngleAxisd(radians(30), Vec3::UnitZ());
  scene.instances[1].name = "wall_0";
  scene.instances[2].name = "floor";
  scene.bounds_m = {Vec3(-9, -7, -5.2), Vec3(9, 7, 0)};
  scene.navigable_m = {Vec3(-8, -6, -4.5), Vec3(8, 5.5, -0.5)};
  return scene;
}

Trajectory swim(PathSpec path, double rounding_m = 1.0) {
  TrajectoryPoses spec;
  spec.path = std::move(path);
  spec.rounding_m = rounding_m;
  return {spec, harbour(), RandomKey{}};
}

RecordedPath recorded(std::vector<StampedPose> poses) {
  return {"a.txt", std::make_shared<const std::vector<StampedPose>>(std::move(poses))};
}

double yaw_of(const Pose& pose) { return roll_pitch_yaw(pose)[2]; }

TEST(Orbit, KeepsItsRadiusDepthAndSpeedAndLooksAtTheCentre) {
  const Vec3 centre(1, 0, -2.5);
  const Trajectory orbit = swim(Orbit{"block", 3.0, 1.5, {}, {}, false, 90.0});
  EXPECT_TRUE(orbit.at(0).translation().isApprox(Vec3(1, 3, -1.5), 1e-9));
  const double round_s = 2 * pi * 3 / 0.5;
  EXPECT_NEAR(orbit.repeats_s(), round_s, 1e-9);
  for (double t = 0; t < 2 * round_s; t += 0.37) {
    const Pose pose = orbit.at(t);
    const Vec3 p = pose.translation();
    EXPECT_NEAR((p - centre).head<2>().norm(), 3.0, 1e-6);  // the box of a float mesh
    EXPECT_NEAR(p.z(), -1.5, 1e-12);
    EXPECT_LT((pose.linear().col(0) - (centre - p).normalized()).norm(), 1e-6);
    EXPECT_NEAR(roll_pitch_yaw(pose)[0], 0.0, 1e-12);
    const double bearing = std::atan2(p.y(), p.x() - 1);
    EXPECT_NEAR(std::remainder(bearing - (0.5 * pi + 0.5 * t / 3), 2 * pi), 0.0, 1e-6);
  }
  const Motion motion = motion_of(orbit, round_s);
  EXPECT_NEAR(motion.length_m, 2 * pi * 3, 0.05);
  EXPECT_NEAR(motion.max_acceleration_mps2, 0.25 / 3, 1e-4);
  EXPECT_NEAR(motion.max_turn_rate_radps, 0.5 / 3, 1e-6);
}

TEST(Orbit, TurnsThenGoesBackClockwiseToo) {
  const Trajectory orbit = swim(Orbit{Vec3(0, 0, -2), 2.0, 2.0, 10.0, 1.5, true, 0.0});
  EXPECT_TRUE(orbit.at(0).translation().isApprox(Vec3(2, 0, -2), 1e-9));
  EXPECT_NEAR(roll_pitch_yaw(orbit.at(7))[1], radians(10), 1e-9);
  const double half_s = 0.5 * orbit.repeats_s();
  EXPECT_TRUE(orbit.at(half_s).translation().isApprox(Vec3(-2, 0, -2), 1e-9));  // 1.5 turns
  EXPECT_LT(orbit.at(5).translation().y(), 0);                                  // clockwise from the east: south
  for (double t = 0; t < half_s; t += 0.5) EXPECT_TRUE(orbit.at(half_s - t).isApprox(orbit.at(half_s + t), 1e-9));
}

// Every point of the area lies within half a spacing of a lane, lanes are parallel, alternate and keep their distance.
TEST(LawnmowerLanes, CoverTheArea) {
  const Eigen::AlignedBox2d area(Eigen::Vector2d(-3, -2), Eigen::Vector2d(4, 3));
  for (const double heading : {0.0, 90.0, 37.0, -120.0}) {
    const Lawnmower mow{1.0, 0.8, heading, 0.0, {}};
    const auto lanes = survey_lanes(mow, area);
    const Eigen::Vector2d along(std::cos(radians(heading)), std::sin(radians(heading)));
    const Eigen::Vector2d aside(-along.y(), along.x());
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const Eigen::Vector2d way = lanes[i].to_m - lanes[i].from_m;
      EXPECT_NEAR(way.dot(along) * (i % 2 == 0 ? 1 : -1), way.norm(), 1e-9);
      if (i > 0) {
        const double apart = (lanes[i].from_m - lanes[i - 1].from_m).dot(aside);
        EXPECT_LE(apart, 0.8 + 1e-9);
        EXPECT_GT(apart, 0.4);
      }
      EXPECT_LT(area.squaredExteriorDistance(lanes[i].from_m) + area.squaredExteriorDistance(lanes[i].to_m), 1e-18);
    }
    for (double x = -3; x <= 4; x += 0.1) {
      for (double y = -2; y <= 3; y += 0.1) {
        double nearest = 99;
        for (const Lane& lane : lanes) {
          nearest = std::min(nearest, std::abs((Eigen::Vector2d(x, y) - lane.from_m).dot(aside)));
        }
        ASSERT_LE(nearest, 0.4 + 1e-9) << x << " " << y;
      }
    }
  }
  EXPECT_THROW(survey_lanes({1.0, 1e-5, 0.0, 0.0, {}}, area), ConfigError);
}

// It stays in the area, at its depth, looks where it goes wherever it swims straight, and begins and ends each round at
// rest on its heading.
TEST(Lawnmower, LooksAheadStaysInsideAndComesBack) {
  const Lawnmower mow{1.0, 2.0, 20.0, 15.0, {}};
  const Trajectory way = swim(mow);
  const Eigen::AlignedBox2d area(Eigen::Vector2d(-8, -6), Eigen::Vector2d(8, 5.5));
  EXPECT_LT((way.at(0.001).translation() - way.at(0).translation()).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(way.at(0)), radians(20), 1e-9);
  const auto lanes = survey_lanes(mow, area);
  EXPECT_LT((way.at(0).translation().head<2>() - lanes.front().from_m).norm(), 1e-9);
  double straight_s = 0;
  for (double t = 0; t < way.repeats_s(); t += 0.1) {
    const Pose pose = way.at(t);
    EXPECT_LT(area.squaredExteriorDistance(pose.translation().head<2>()), 1e-18) << t;
    EXPECT_NEAR(pose.translation().z(), -1.0, 1e-12);
    EXPECT_NEAR(roll_pitch_yaw(pose)[1], radians(15), 1e-9);
    const Vec3 velocity = (way.at(t + 0.01).translation() - pose.translation()) / 0.01;
    if (velocity.norm() < 0.4999) continue;
    straight_s += 0.1;
    EXPECT_NEAR(std::remainder(std::atan2(velocity.y(), velocity.x()) - yaw_of(pose), 2 * pi), 0.0, 0.02) << t;
  }
  double lanes_m = 0;
  for (const Lane& lane : lanes) lanes_m += (lane.to_m - lane.from_m).norm();
  EXPECT_GT(straight_s * 0.5, 2 * (lanes_m - 2.1 * static_cast<double>(lanes.size())));  // but for 1 m about each turn
  EXPECT_TRUE(way.at(way.repeats_s()).isApprox(way.at(0), 1e-9));
}

double distance_to_block_m(const Vec3& p) {
  const Vec3 local = Eigen::AngleAxisd(radians(-30), Vec3::UnitZ()) * (p - Vec3(1, 0, -2.5));
  return (local.cwiseAbs() - Vec3(1.5, 1, 1.5)).cwiseMax(0.0).norm();
}

// Round a block that stands askew: standoff exact along its sides and 2 % at its corners, and the sonar looks at the
// nearest point: a ray along its axis meets the block at the standoff.
TEST(Wall, GoesRoundABlockAtItsStandoff) {
  const Scene scene = harbour();
  const RayScene rays(scene);
  const Trajectory way = swim(WallFollow{"block", 1.2, 2.5, 0.0, Side::all, false});
  const double round_m = way.repeats_s() * 0.5;
  EXPECT_NEAR(round_m, 2 * (3 + 2) + 2 * pi * 1.2, 0.01);
  double winding = 0;
  int exact = 0, looks = 0;
  for (double t = 0; t < way.repeats_s(); t += 0.1) {
    const Pose pose = way.at(t);
    const Vec3 p = pose.translation();
    const double distance = distance_to_block_m(p);
    EXPECT_GE(distance, 1.2 * 0.98) << t;
    EXPECT_LE(distance, 1.2 + 1e-5) << t;
    exact += std::abs(distance - 1.2) < 1e-5;
    const auto hit = first_hit_m(rays, p, pose.linear().col(0), 10.0);
    ++looks;
    ASSERT_TRUE(hit.has_value()) << t;
    EXPECT_NEAR(*hit, distance, 0.03) << t;
    const Vec3 q = way.at(t + 0.1).translation();
    winding += std::remainder(std::atan2(q.y(), q.x() - 1) - std::atan2(p.y(), p.x() - 1), 2 * pi);
  }
  EXPECT_GT(exact, 0.3 * looks);
  EXPECT_NEAR(winding, 2 * pi, 0.1);  // counter-clockwise
  const Motion motion = motion_of(way, way.repeats_s());
  EXPECT_LE(motion.max_acceleration_mps2, 1.05 * 0.25 / 1.2);
  EXPECT_LE(motion.max_turn_rate_radps, 1.01 * 0.5 / 1.2);
}

// The north wall leaves the navigable box on all sides but one: there and back along it, looking north.
TEST(Wall, FollowsWhatLiesInTheNavigableBox) {
  const Trajectory way = swim(WallFollow{"wall", 1.5, 2.0, 5.0, Side::all, false});
  double west = 9, east = -9;
  for (double t = 0; t < way.repeats_s(); t += 0.1) {
    const Pose pose = way.at(t);
    EXPECT_NEAR(pose.translation().y(), 4.5, 1e-6);
    EXPECT_NEAR(yaw_of(pose), 0.5 * pi, 1e-9);
    west = std::min(west, pose.translation().x());
    east = std::max(east, pose.translation().x());
  }
  EXPECT_NEAR(west, -8, 0.35);
  EXPECT_NEAR(east, 8, 0.35);
  EXPECT_THROW(swim(WallFollow{"wall", 1.5, 2.0, 5.0, Side::north, false}), ConfigError);
}

TEST(Wall, SidesAreWhereTheVehicleIs) {
  for (const auto& [side, bearing_deg] :
       {std::pair{Side::east, 0.0}, {Side::north, 90.0}, {Side::west, 180.0}, {Side::south, -90.0}}) {
    const Trajectory way = swim(WallFollow{"block", 1.0, 2.5, 0.0, side, false});
    for (double t = 0; t < way.repeats_s(); t += 0.2) {
      const double looks_from = yaw_of(way.at(t)) + pi;
      EXPECT_LE(std::abs(std::remainder(looks_from - radians(bearing_deg), 2 * pi)), radians(45.1));
    }
  }
}

TEST(ObjectOutline, IsTheHullOfTheSectionAtItsHeight) {
  Scene scene = test::scene_of({test::sphere_mesh(2.0), test::moved(test::sphere_mesh(2.0), {5, 0, 0})});
  scene.instances[0].name = "ball_0";
  scene.instances[1].name = "ball_1";
  for (const Eigen::Vector2d& p : object_outline_m(scene, "ball_0", 1.0, 1.5))
    EXPECT_NEAR(p.norm(), std::sqrt(3.0), 0.01);
  const auto both = object_outline_m(scene, "ball", -0.1, 0.1);
  const auto east = std::max_element(both.begin(), both.end(), [](auto& a, auto& b) { return a.x() < b.x(); });
  EXPECT_NEAR(east->x(), 7.0, 0.01);
  double twice_area = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto& a = both[i];
    const auto& b = both[(i + 1) % both.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  EXPECT_NEAR(0.5 * twice_area, pi * 4 + 5 * 4, 0.1);  // counter-clockwise, two half discs and what lies between
  EXPECT_THROW(object_outline_m(scene, "ball", 2.1, 3), ConfigError);
  EXPECT_THROW(object_box_m(scene, "bal"), ConfigError);
}

TEST(RecordedPath, GivesItsPosesAtItsTimes) {
  const Pose a = pose_from_xyz_rpy({0, 0, -2}, 0, 0, 0);
  const Pose b = pose_from_xyz_rpy({1, 2, -3}, 0.1, 0.2, 1.0);
  const Trajectory way = swim(recorded({{100.0, a}, {102.0, b}, {103.0, a}}));
  EXPECT_EQ(way.lasts_s(), 3.0);
  EXPECT_FALSE(way.speed_mps().has_value());
  EXPECT_TRUE(way.at(0).isApprox(a, 1e-12));
  EXPECT_TRUE(way.at(2).isApprox(b, 1e-12));
  EXPECT_TRUE(way.at(3).isApprox(a, 1e-12));
  EXPECT_TRUE(way.at(1).translation().isApprox(Vec3(0.5, 1, -2.5), 1e-12));
  const Eigen::AngleAxisd whole(a.linear().transpose() * b.linear()), half(a.linear().transpose() * way.at(1).linear());
  EXPECT_NEAR(half.angle(), 0.5 * whole.angle(), 1e-9);
  EXPECT_TRUE(swim(recorded({{5.0, b}})).at(0).isApprox(b, 1e-12));
}

// The vehicle rocks in its own axes about the path, and nothing else moves.
TEST(AttitudeNoise, RocksTheAttitudeAlone) {
  TrajectoryPoses spec;
  spec.path = Orbit{Vec3(0, 0, -2), 3.0, 2.0, 0.0, {}, false, 0.0};
  spec.attitude_noise = {3.0, 0.0, 0.0, 5.0};
  const Trajectory way(spec, harbour(), RandomKey::from_seed(1));
  const Trajectory other(spec, harbour(), RandomKey::from_seed(2));
  double square = 0;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.25 * i;
    EXPECT_EQ(way.at(t).translation(), way.path_at(t).translation());
    EXPECT_LT((way.at(t).linear().col(0) - way.path_at(t).linear().col(0)).norm(), 1e-9);  // roll turns about x
    square += std::pow(roll_pitch_yaw(way.at(t))[0], 2) / 1000;
  }
  EXPECT_NEAR(degrees(std::sqrt(square)), 3.0, 1.0);
  EXPECT_FALSE(way.at(4).isApprox(other.at(4), 1e-6));
  EXPECT_TRUE(way.at(4).isApprox(Trajectory(spec, harbour(), RandomKey::from_seed(1)).at(4), 0.0));
}

TEST(Obstruction, IsFoundWhereThePathFirstMeetsIt) {
  const Scene scene = harbour();
  const OccupancyGrid truth = voxelize(scene, 0.1).grid;
  const auto straight = [&](double clearance_m) {
    const Trajectory way =
        swim(OwnWaypoints{{pose_from_xyz_rpy({-6, 0, -2.5}, 0, 0, 0), pose_from_xyz_rpy({6, 0, -2.5}, 0, 0, 0)}});
    return first_obstruction(way, truth, clearance_m, 1e9);
  };
  // Through the middle of the block, whose long side is turned by 30 degrees: met at 1 - 1.5 cos 30 - ..., about -0.73.
  const double met = 1 - std::min(1.5 / std::cos(radians(30)), 1 / std::sin(radians(30)));
  ASSERT_TRUE(straight(0).has_value());
  EXPECT_NEAR(straight(0)->p_world.x(), met, 0.2);
  EXPECT_NEAR(straight(1.0)->p_world.x(), met - 1 / std::cos(radians(30)), 0.25);
  const Trajectory clear = swim(Orbit{"block", 3.0, 2.0, {}, {}, false, 0.0});
  EXPECT_FALSE(first_obstruction(clear, truth, 0.5, 1e9).has_value());
  EXPECT_TRUE(first_obstruction(clear, truth, 1.5, 1e9).has_value());
  // A record that jumps across the block between two poses, and one that leaves the world.
  const Pose here = pose_from_xyz_rpy({-6, 0, -2.5}, 0, 0, 0), there = pose_from_xyz_rpy({6, 0, -2.5}, 0, 0, 0);
  const Trajectory jump = swim(recorded({{0, here}, {1, here}, {1.001, there}, {9, there}}));
  EXPECT_NEAR(first_obstruction(jump, truth, 0, 1e9)->p_world.x(), met, 0.2);
  const Trajectory away = swim(recorded({{0, here}, {1, pose_from_xyz_rpy({-1e6, 0, -2.5}, 0, 0, 0)}}));
  EXPECT_NEAR(first_obstruction(away, truth, 0, 1e9)->p_world.x(), -9, 0.11);
  // Steps below what a time of that size can tell apart do not stop the search.
  const Trajectory late = swim(recorded({{0, here}, {1e9, here}, {1e9 + 1e-6, there}}));
  EXPECT_TRUE(first_obstruction(late, truth, 0, 1e10).has_value());  // one of the eight times there are
}

}  // namespace
}  // namespace ensonify
