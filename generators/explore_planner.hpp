#pragma once

#include <optional>

#include "ensonify/generators/explore_view.hpp"

namespace ensonify {

/// Frontier exploration by information gain (Yamauchi 1997; Gonzalez-Banos and Latombe 2002) in a slice: from the poses
/// that can be reached through columns known to be free, the one is taken whose view holds most unknown columns for the
/// time to get there. Rays reach unknown columns through free ones, so that what counts first is a frontier.
struct PlannerSettings {
  SonarView view;
  MotionLimits limits;
  double radius_m = 0.3;     ///< of the vehicle, an upright cylinder
  double clearance_m = 0.4;  ///< of its axis from whatever is not known to be free
  ColumnMask area;           ///< where its axis may be
  ColumnMask interest;       ///< columns worth knowing
  double least_worth_m2 = 0.05;
  double resolved_m = 2.5;    ///< occupied columns that were seen from so near need no closer look
  double pause_s = 2;         ///< added to the time of a way, so that small gains nearby do not always win
  double spacing_m = 0.6;     ///< of the places that are compared
  double look_ahead_m = 3;    ///< along the way
  double turn_early_m = 1.5;  ///< of way left: from here on it turns to the heading wanted there
};

/// What the planner knows beside the map.
struct PlannerMemory {
  struct Goal {
    PlanarPose pose;
    std::size_t column = 0;
    double worth_m2 = 0;
    int steps = 0;
  };
  LookMemory looks;
  ColumnMask body;   ///< where the vehicle has been: free, as far as it knows
  ColumnMask trail;  ///< where its axis has been: it may always go back
  std::optional<PlanarPose> last;
  std::optional<Goal> goal;
};

/// A memory that holds one belief: the columns within known_free_m of the start are free, though the sonar, which is
/// blind nearby, has not said so.
PlannerMemory memory_at(const Slice& slice, const PlanarPose& start, double known_free_m);

/// The next pose, within the limits of motion, from the map alone; empty where nothing that can be reached is worth a
/// look. `at`: where the last ping was sent, as the vehicle believes. Does not depend on the number of threads.
std::optional<PlanarPose> plan_step(const PlannerSettings& settings, const Slice& map, const PlanarPose& at,
                                    PlannerMemory& memory);

}  // namespace ensonify
