#include "ensonify/core/pose.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {

Pose pose_from_xyz_rpy(const Vec3& position_m, double roll, double pitch, double yaw) {
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(pitch, Vec3::UnitY()) *
                   Eigen::AngleAxisd(roll, Vec3::UnitX()))
                      .toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

std::array<double, 3> roll_pitch_yaw(const Pose& pose) {
  const Eigen::Matrix3d r = pose.rotation();
  const double pitch = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  if (std::hypot(r(2, 1), r(2, 2)) < 1e-6) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

}  // namespace ensonify
