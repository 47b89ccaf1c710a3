#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// A line hung between two points, y(x) = a cosh((x - x0) / a) in the vertical plane through them; straight where the
/// sag is 0. `sag_m` is the greatest vertical distance below the straight line between the ends.
class HangingLine {
 public:
  /// The ends differ; a sag above 0 needs them apart horizontally and is at most 20 times that distance.
  HangingLine(const Vec3& from_m, const Vec3& to_m, double sag_m);

  double length_m() const { return length_m_; }
  /// Point at `share` (0..1) of the length.
  Vec3 at(double share) const;
  /// `pieces` + 1 points, evenly spaced along the line.
  std::vector<Vec3> points_m(int pieces) const;

 private:
  Vec3 from_m_, to_m_;
  double length_m_;
  double span_m_ = 0;         // horizontal distance of the ends
  double a_m_ = 0;            // radius at the lowest point; 0: straight
  double lowest_x_m_ = 0;     // of the curve, from the first end along the span; may lie outside
  double arc_at_from_m_ = 0;  // length from the lowest point to the first end, signed
};

}  // namespace ensonify
