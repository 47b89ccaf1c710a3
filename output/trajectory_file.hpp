#pragma once

#include <filesystem>
#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

struct StampedPose {
  double time_s = 0;
  Pose T_world_sonar = Pose::Identity();
};

/// TUM text: `timestamp tx ty tz qx qy qz qw` a line, metres, world frame, sonar pose; whole or not at all.
void write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses);

}  // namespace ensonify
