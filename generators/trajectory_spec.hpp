#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/output/trajectory_file.hpp"

namespace ensonify {

// What a recipe may ask a vehicle to swim: metres, degrees as in the file, world frame. Depths are positive.

/// The scene's own waypoints, there and back.
struct SceneWaypoints {};

/// Waypoints of the recipe, there and back.
struct OwnWaypoints {
  std::vector<Pose> T_world_sonar;
};

/// Parallel lanes over a rectangle at one depth, looking ahead; then the same lanes the other way, and so on.
struct Lawnmower {
  double depth_m = 0;
  double spacing_m = 0;                       ///< between lanes, at most
  double heading_deg = 0;                     ///< of the first lane, counter-clockwise from east
  double pitch_deg = 0;                       ///< positive is nose down
  std::optional<Eigen::AlignedBox2d> area_m;  ///< empty: the navigable box
};

/// A level circle, looking at its centre.
struct Orbit {
  std::variant<std::string, Vec3> about;  ///< an object (the centre of its bounding box), or a point
  double radius_m = 0;                    ///< horizontal
  double depth_m = 0;
  std::optional<double> pitch_deg;  ///< empty: so that the sonar looks at the centre
  std::optional<double> turns;      ///< then back; empty: round and round
  bool clockwise = false;           ///< seen from above
  double start_deg = 0;             ///< where it begins: bearing from the centre, counter-clockwise from east
};

enum class Side { all, east, north, west, south };

/// Along an object at a distance, looking at it squarely: the outline of its horizontal section's convex hull, widened
/// by `standoff_m`, as far as it lies in the navigable box.
struct WallFollow {
  std::string object;
  double standoff_m = 0;
  double depth_m = 0;
  double pitch_deg = 0;
  Side side = Side::all;   ///< where the vehicle is, seen from the object: the parts that face so within 45 degrees
  bool clockwise = false;  ///< about the object, seen from above
};

/// Poses of a TUM file at its times, the first being the start; between them straight lines and slerp. At least one
/// pose, times ascending. Shared, because recipes are copied and a file may hold a million poses.
struct RecordedPath {
  std::filesystem::path file;
  std::shared_ptr<const std::vector<StampedPose>> poses;
};

using PathSpec = std::variant<SceneWaypoints, OwnWaypoints, Lawnmower, Orbit, WallFollow, RecordedPath>;

/// How the vehicle rocks about its path: zero-mean, in its own axes, rms.
struct AttitudeNoise {
  double roll_deg = 0;
  double pitch_deg = 0;
  double yaw_deg = 0;
  double period_s = 6;
};

/// Poses swum one after the other.
struct TrajectoryPoses {
  PathSpec path;
  Distribution speed_mps = Constant{0.5};  ///< drawn once a place; not of a recorded path
  double rate_hz = 2;
  double rounding_m = 1;   ///< see `SmoothedWay`
  double clearance_m = 0;  ///< radius that must be free all along
  AttitudeNoise attitude_noise;
  bool motion_during_ping = false;  ///< the sonar goes on while the sound is under way (see `receive_in_motion`)
  std::string where;                ///< file, line and key, for errors that show only once the place is built
};

}  // namespace ensonify
