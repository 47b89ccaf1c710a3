#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// Straight legs between waypoints; attitude turns evenly along a leg (slerp), so yaw differences between neighbouring
/// waypoints must stay below 180 degrees.
class WaypointPath {
 public:
  /// At least two waypoints, not all at one place, else ConfigError.
  explicit WaypointPath(std::vector<Pose> waypoints);

  double length_m() const { return start_m_.back(); }
  /// Pose `travelled_m` along the path; beyond its end the way goes back, and so on.
  Pose at(double travelled_m) const;

 private:
  std::vector<Pose> waypoints_;
  std::vector<double> start_m_;  ///< way to each waypoint
};

}  // namespace ensonify
