#pragma once

#include <filesystem>
#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

struct StampedPose {
  double time_s = 0;
  Pose T_world_sonar = Pose::Identity();
};

/// TUM text: `timestamp tx ty tz qx qy qz qw` a line, metres, world frame, sonar pose; whole or not at all. Nine digits
/// behind the point: read again, a pose is the same to 1e-9 m and 1e-9 rad.
void write_tum(const std::filesystem::path& path, const std::vector<StampedPose>& poses);

/// Reads TUM text; lines that start with # and empty ones are skipped. At least one pose, times ascending, positions
/// within 1000 km, quaternions of norm 1 to 1 % (then normalised), at most 256 MiB and 2 million poses; else DataError
/// with file and line.
std::vector<StampedPose> read_tum(const std::filesystem::path& path);

}  // namespace ensonify
