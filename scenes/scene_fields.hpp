#pragma once

#include <string_view>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/config/reader.hpp"

namespace ensonify {

/// Reads fields of a layout: where the file gives a distribution, it is sampled on the spot, in the order of reading.
struct FieldSampler {
  Reader& reader;
  RandomSequence& random;

  double number(std::string_view key, Limits limits = any_number) const;
  double number_or(std::string_view key, double fallback, Limits limits = any_number) const;
  /// Rounded to the nearest whole number.
  int count(std::string_view key, int low, int high) const;
  int count_or(std::string_view key, int fallback, int low, int high) const;
  /// Degrees in the file, radians returned; the key ends in _deg.
  double angle_or(std::string_view key, double fallback_deg, Limits limits_deg = any_number) const;
};

/// `key` as [x, y, z] or [x, y, z, roll, pitch, yaw] (m, degrees), or as a mapping {x_m, y_m, z_m, roll_deg, pitch_deg,
/// yaw_deg} whose values may be distributions.
Pose read_pose(Reader& reader, std::string_view key, RandomSequence& random);

/// [[a, b, ...], ...]: `low` to `high` entries of `dimensions` finite numbers within 10 km of 0. `form` says how an
/// entry looks, such as "[x, y]".
std::vector<std::vector<double>> read_points(Reader& reader, std::string_view key, std::size_t dimensions,
                                             std::size_t low, std::size_t high, std::string_view form);

/// A list of [x, y, z, roll, pitch, yaw] (m, degrees) under `key`.
std::vector<Pose> read_waypoints(Reader& reader, std::string_view key);

/// {min: [x, y, z], max: [x, y, z]} (m), not empty along any axis.
Eigen::AlignedBox3d read_box(Reader& reader, std::string_view key);

}  // namespace ensonify
