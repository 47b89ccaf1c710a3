#pragma once

#include <vector>

#include "ensonify/generators/explore_slice.hpp"

namespace ensonify {

/// Where a vehicle that keeps depth, roll and pitch is and looks; world frame, m and rad.
struct PlanarPose {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;
};

/// How a vehicle may move: any way in the plane, turning meanwhile.
struct MotionLimits {
  double speed_mps = 0.5;
  double turn_radps = radians(30);
  double ping_rate_hz = 2;

  double step_m() const { return speed_mps / ping_rate_hz; }
  double step_rad() const { return turn_radps / ping_rate_hz; }
};

/// The angle from one heading to another, in [-pi, pi).
double turn_between(double from_rad, double to_rad);

/// As far from `from` towards `wanted` as one step allows.
PlanarPose limited_step(const PlanarPose& from, const PlanarPose& wanted, const MotionLimits& limits);

/// Shortest ways from one column to all others through allowed ones: Dijkstra (1959) over eight neighbours, diagonals
/// only between two allowed columns.
struct Ways {
  std::vector<double> length_m;      ///< infinite where there is no way
  std::vector<std::int32_t> before;  ///< the column before on the way, -1 at the start and where there is none

  bool reaches(std::size_t column) const { return std::isfinite(length_m[column]); }
};
Ways shortest_ways(const Slice& slice, const ColumnMask& allowed, int ix, int iy);

/// Does the straight line stay within allowed columns?
bool line_allowed(const Slice& slice, const ColumnMask& allowed, double x0_m, double y0_m, double x1_m, double y1_m);

/// Columns of the way, start and end included; empty where there is none.
std::vector<std::size_t> way_to(const Ways& ways, std::size_t column);

/// The point to make for: the farthest column's centre along the way, at most look_ahead_m of it, that a straight line
/// through allowed columns leads to.
PlanarPose carrot(const Slice& slice, const ColumnMask& allowed, const std::vector<std::size_t>& way,
                  const PlanarPose& from, double look_ahead_m);

}  // namespace ensonify
