#pragma once

#include "ensonify/generators/explore_ways.hpp"

namespace ensonify {

/// What of the true slice a run is judged by.
struct ReachableSlice {
  /// Columns that some part of an upright cylinder of the vehicle's radius covers on its ways from the start: its axis
  /// stays in the area and at least the radius off every occupied column. All of them are free.
  ColumnMask free;
  /// Occupied columns that a straight line of at most the sonar's range joins with a place of the axis.
  ColumnMask boundary;
};

/// From the truth. `axis_area`: columns where the axis may be. Empty masks where the start itself has no room.
ReachableSlice reachable_slice(const Slice& truth, const ColumnMask& axis_area, const PlanarPose& start,
                               double radius_m, double sonar_range_m);

/// Shares; NaN for 0 / 0. As in Lin et al. (ICRA 2023) free counts as positive, and unknown columns are left out of the
/// two rates.
struct ExploreScores {
  double coverage = 0;        ///< of the free columns: known to be free
  double boundary_found = 0;  ///< of the boundary: known to be occupied
  double fpr = 0;             ///< of the boundary's known columns: said to be free
  double fnr = 0;             ///< of the free ones' known columns: said to be occupied
};
ExploreScores score_slice(const Slice& map, const ReachableSlice& reachable);

/// The least distance (m) of the points of a straight way from occupied columns: every 2 cm and at both ends; at most
/// `far_m`.
double clearance_m(const Slice& truth, const PlanarPose& from, const PlanarPose& to, double far_m);

}  // namespace ensonify
