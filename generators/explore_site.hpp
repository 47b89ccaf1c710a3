#pragma once

#include <optional>

#include "ensonify/generators/explore_planner.hpp"
#include "ensonify/generators/explore_scores.hpp"
#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// An upright cylinder that keeps its depth, the sonar in its middle. It may move any way in the plane and turn
/// meanwhile.
struct Vehicle {
  double radius_m = 0.3;
  double height_m = 0.3;
  double margin_m = 0.15;  ///< the planner keeps so much more than the radius off what is not known to be free
  MotionLimits limits;
};

/// What is asked of a run's place; what is empty comes from the scene.
struct SiteRequest {
  std::optional<double> resolution_m;  ///< of map and truth
  std::optional<double> z_m;           ///< of the sonar; else that of the start
  std::optional<Pose> start;           ///< else the first waypoint, level, else the middle of the navigable box
  std::optional<double> known_free_m;  ///< radius about the start; else as far as the sonar is blind, and a cell
};

/// Where a run takes place, and the truth that it is judged by. The planner gets the parts that a mission knows: frame,
/// start, view, area.
struct ExploreSite {
  Pose start = Pose::Identity();
  GridFrame map_frame;  ///< of the mapper: the layers that the vehicle touches, or under `points` the sonar's alone
  SonarView view;
  double known_free_m = 0;
  ColumnMask area;      ///< the scene's navigable box: where the axis may be
  ColumnMask interest;  ///< that box and the radius about it
  Slice truth;
  ReachableSlice reachable;

  PlanarPose planar_start() const;
  /// T_world_sonar with the depth, roll and pitch of the start.
  Pose pose_at(const PlanarPose& planar) const;
};

PlanarPose planar(const Pose& pose);

/// Throws ConfigError: bounds that the vehicle leaves, a start without room, or without the room that is taken as known
/// there.
ExploreSite explore_site(const Scene& scene, const SonarModel& sonar, const InverseModel& model, const Vehicle& vehicle,
                         const SiteRequest& request);

}  // namespace ensonify
