#pragma once

#include <Eigen/Geometry>
#include <array>
#include <numbers>

namespace ensonify {

using Vec3 = Eigen::Vector3d;

/// Rigid transform. `T_a_b` maps coordinates of frame b into frame a: p_a = T_a_b * p_b.
/// World: ENU, metres, z = 0 at the mean water surface. Sonar: x forward, y left, z up (REP-103).
using Pose = Eigen::Isometry3d;

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

/// Pose from position (m) and angles (rad), R = Rz(yaw) Ry(pitch) Rx(roll); positive pitch is nose down.
Pose pose_from_xyz_rpy(const Vec3& position_m, double roll, double pitch, double yaw);

/// Roll, pitch, yaw (rad) of the rotation, pitch in [-pi/2, pi/2]. Within 1e-6 rad of straight down or up, where roll
/// and yaw turn about one axis, roll is 0.
std::array<double, 3> roll_pitch_yaw(const Pose& pose);

}  // namespace ensonify
