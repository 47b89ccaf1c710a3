#include "ensonify/generators/read_trajectory.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ensonify/scenes/scene_fields.hpp"

namespace ensonify {
namespace {

constexpr Limits depth_limits{0.0, 1e5};
constexpr Limits size_limits{0.01, 1e5};
constexpr Limits turn_limits{-3600.0, 3600.0};
constexpr Limits pitch_limits{-89.0, 89.0};
constexpr Limits rms_limits{0.0, 45.0};

Lawnmower read_lawnmower(Reader mow) {
  Lawnmower result;
  result.depth_m = mow.number("depth_m", depth_limits);
  result.spacing_m = mow.number("spacing_m", size_limits);
  result.heading_deg = mow.number_or("heading_deg", result.heading_deg, turn_limits);
  result.pitch_deg = mow.number_or("pitch_deg", result.pitch_deg, pitch_limits);
  if (mow.has("area")) {
    const std::vector<double> a = mow.numbers("area", 4, {-1e5, 1e5});
    if (a[0] >= a[2] || a[1] >= a[3]) mow.fail("area", "must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1, in metres");
    result.area_m.emplace(Eigen::Vector2d(a[0], a[1]), Eigen::Vector2d(a[2], a[3]));
  }
  mow.finish();
  return result;
}

Orbit read_orbit(Reader orbit) {
  Orbit result;
  const bool object = orbit.has("object");
  if (object == orbit.has("center")) orbit.fail("", "needs either 'object' or 'center'");
  if (object) {
    result.about = orbit.text("object");
  } else {
    const std::vector<double> c = orbit.numbers("center", 3, {-1e5, 1e5});
    result.about = Vec3(c[0], c[1], c[2]);
  }
  result.radius_m = orbit.number("radius_m", size_limits);
  result.depth_m = orbit.number("depth_m", depth_limits);
  if (orbit.has("pitch_deg")) result.pitch_deg = orbit.number("pitch_deg", pitch_limits);
  if (orbit.has("turns")) result.turns = orbit.number("turns", {0.01, 1e6});
  result.clockwise = orbit.boolean_or("clockwise", result.clockwise);
  result.start_deg = orbit.number_or("start_deg", result.start_deg, turn_limits);
  orbit.finish();
  return result;
}

WallFollow read_wall(Reader wall) {
  WallFollow result;
  result.object = wall.text("object");
  result.standoff_m = wall.number("standoff_m", size_limits);
  result.depth_m = wall.number("depth_m", depth_limits);
  result.pitch_deg = wall.number_or("pitch_deg", result.pitch_deg, pitch_limits);
  if (wall.has("side")) {
    const std::vector<std::string> sides{"all", "east", "north", "west", "south"};  // in the order of Side
    const std::string side = wall.choice("side", sides);
    result.side = static_cast<Side>(std::find(sides.begin(), sides.end(), side) - sides.begin());
  }
  result.clockwise = wall.boolean_or("clockwise", result.clockwise);
  wall.finish();
  return result;
}

RecordedPath read_recorded(const Reader& trajectory, const std::string& file) {
  const std::filesystem::path path = trajectory.folder() / file;
  return {path, std::make_shared<const std::vector<StampedPose>>(read_tum(path))};
}

PathSpec read_path(Reader& trajectory, std::string& where) {
  std::vector<std::string> given;
  for (const char* kind : {"path", "waypoints", "lawnmower", "orbit", "wall", "file"}) {
    if (trajectory.has(kind)) given.emplace_back(kind);
  }
  if (given.size() > 1) {
    trajectory.fail(given[1],
                    fmt::format("is one path too many beside '{}'; keep one of {}", given[0], fmt::join(given, ", ")));
  }
  if (given.empty()) {
    where = trajectory.where("");
    return SceneWaypoints{};
  }
  const std::string& kind = given.front();
  where = trajectory.where(kind);
  if (kind == "waypoints") {
    OwnWaypoints own{read_waypoints(trajectory, kind)};
    if (own.T_world_sonar.size() < 2) trajectory.fail(kind, "needs at least two");
    return own;
  }
  if (kind == "lawnmower") return read_lawnmower(trajectory.child(kind));
  if (kind == "orbit") return read_orbit(trajectory.child(kind));
  if (kind == "wall") return read_wall(trajectory.child(kind));
  if (kind == "file") return read_recorded(trajectory, trajectory.text(kind));
  if (trajectory.text(kind) != "waypoints") {
    trajectory.fail(kind,
                    "must be waypoints (those of the scene); other paths are given as one of the keys waypoints, "
                    "lawnmower, orbit, wall, file");
  }
  return SceneWaypoints{};
}

AttitudeNoise read_attitude_noise(Reader noise) {
  AttitudeNoise result;
  result.roll_deg = noise.number_or("roll_deg", result.roll_deg, rms_limits);
  result.pitch_deg = noise.number_or("pitch_deg", result.pitch_deg, rms_limits);
  result.yaw_deg = noise.number_or("yaw_deg", result.yaw_deg, rms_limits);
  result.period_s = noise.number_or("period_s", result.period_s, {0.1, 1e4});
  noise.finish();
  return result;
}

}  // namespace

TrajectoryPoses read_trajectory(Reader trajectory) {
  TrajectoryPoses result;
  result.path = read_path(trajectory, result.where);
  result.rate_hz = trajectory.number_or("rate_hz", result.rate_hz, {0.001, 1000.0});
  result.motion_during_ping = trajectory.boolean_or("motion_during_ping", false);
  if (std::holds_alternative<RecordedPath>(result.path)) {
    for (const char* key : {"speed_mps", "rounding_m"}) {
      if (trajectory.has(key)) trajectory.fail(key, "does not go with 'file', whose poses have times; leave it out");
    }
  }
  result.speed_mps = read_distribution_or(trajectory, "speed_mps", 0.5, {0.001, 20.0});
  result.rounding_m = trajectory.number_or("rounding_m", result.rounding_m, {0.05, 100.0});
  result.clearance_m = trajectory.number_or("clearance_m", result.clearance_m, {0.0, 10.0});
  if (trajectory.has("attitude_noise")) result.attitude_noise = read_attitude_noise(trajectory.child("attitude_noise"));
  trajectory.finish();
  return result;
}

}  // namespace ensonify
