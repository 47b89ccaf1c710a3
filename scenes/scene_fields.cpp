#include "ensonify/scenes/scene_fields.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace ensonify {
namespace {

constexpr Limits place_m{-1e5, 1e5};
constexpr Limits turn_deg{-3600, 3600};

}  // namespace

double FieldSampler::number(std::string_view key, Limits limits) const {
  return sample(read_distribution(reader, key, limits), random);
}

double FieldSampler::number_or(std::string_view key, double fallback, Limits limits) const {
  return sample(read_distribution_or(reader, key, fallback, limits), random);
}

int FieldSampler::count(std::string_view key, int low, int high) const {
  return static_cast<int>(std::lround(number(key, {static_cast<double>(low), static_cast<double>(high)})));
}

int FieldSampler::count_or(std::string_view key, int fallback, int low, int high) const {
  return reader.has(key) ? count(key, low, high) : fallback;
}

double FieldSampler::angle_or(std::string_view key, double fallback_deg, Limits limits_deg) const {
  return radians(number_or(key, fallback_deg, limits_deg));
}

Pose read_pose(Reader& reader, std::string_view key, RandomSequence& random) {
  if (reader.node(key).IsMap()) {
    Reader child = reader.child(key);
    const FieldSampler field{child, random};
    const double x = field.number_or("x_m", 0, place_m);
    const double y = field.number_or("y_m", 0, place_m);
    const double z = field.number_or("z_m", 0, place_m);
    const double roll = field.angle_or("roll_deg", 0, turn_deg);
    const double pitch = field.angle_or("pitch_deg", 0, turn_deg);
    const double yaw = field.angle_or("yaw_deg", 0, turn_deg);
    child.finish();
    return pose_from_xyz_rpy({x, y, z}, roll, pitch, yaw);
  }
  std::vector<double> v = reader.numbers(key, -1, place_m);
  if (v.size() == 3) v.resize(6, 0.0);
  if (v.size() != 6) reader.fail(key, "must be [x, y, z] or [x, y, z, roll, pitch, yaw] in metres and degrees");
  return pose_from_xyz_rpy({v[0], v[1], v[2]}, radians(v[3]), radians(v[4]), radians(v[5]));
}

std::vector<std::vector<double>> read_points(Reader& reader, std::string_view key, std::size_t dimensions,
                                             std::size_t low, std::size_t high, std::string_view form) {
  constexpr double far_m = 1e4;
  const YAML::Node list = reader.node(key);
  const auto refuse = [&](const std::string& why) { reader.fail(key, why); };
  if (!list.IsSequence() || list.size() < low || list.size() > high) {
    refuse(fmt::format("must be a list of {} to {} entries {}", low, high, form));
  }
  std::vector<std::vector<double>> points;
  for (const auto& entry : list) {
    std::vector<double> point;
    for (const auto& item : entry) {
      double number = 0;
      if (!item.IsScalar() || !YAML::convert<double>::decode(item, number) || !(std::abs(number) <= far_m)) break;
      point.push_back(number);
    }
    if (!entry.IsSequence() || point.size() != dimensions || entry.size() != dimensions) {
      refuse(fmt::format("entry {} must be {}, numbers between -{:g} and {:g}", points.size(), form, far_m, far_m));
    }
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<Pose> read_waypoints(Reader& reader, std::string_view key) {
  std::vector<Pose> poses;
  for (const auto& v : read_points(reader, key, 6, 1, 10'000, "[x, y, z, roll, pitch, yaw] in metres and degrees")) {
    poses.push_back(pose_from_xyz_rpy({v[0], v[1], v[2]}, radians(v[3]), radians(v[4]), radians(v[5])));
  }
  return poses;
}

Eigen::AlignedBox3d read_box(Reader& reader, std::string_view key) {
  Reader child = reader.child(key);
  const Vec3 low = child.vec3("min");
  const Vec3 high = child.vec3("max");
  child.finish();
  if ((low.array() >= high.array()).any()) reader.fail(key, "min must be below max along every axis");
  if (low.minCoeff() < place_m.low || high.maxCoeff() > place_m.high) reader.fail(key, "must lie within 100 km");
  return {low, high};
}

}  // namespace ensonify
