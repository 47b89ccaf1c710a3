#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// x, y, z (m), roll, pitch, yaw (rad). Yaw may go on beyond a turn.
using PoseVector = Eigen::Matrix<double, 6, 1>;

Pose pose_of(const PoseVector& vector);
/// Where pitch is 90 degrees, roll is taken as 0.
PoseVector vector_of(const Pose& pose);

/// A piece of a way: what changes, evenly, over its length. Length 0 with a change is a jump (a turn on the spot).
struct Leg {
  double length_m = 0;
  PoseVector change = PoseVector::Zero();
};

/// Legs one after the other, over and over, smoothed: the value at s is the average of the legs' values over
/// s - rounding_m .. s + rounding_m, weighted by K(u) = 15 / (16 h) (1 - (u / h)^2)^2 with h = rounding_m.
///
/// - Third derivatives are continuous: no jump of velocity, turn rate or acceleration at a constant speed along s.
/// - On a straight leg, further than h from its ends, the value is exactly the leg's. Elsewhere it stays within 5/16 h
///   of the legs, and within their convex hull.
/// - A corner by alpha is swum slower, at cos(alpha / 2) of the speed v in its middle and with at most
///   15 v^2 / (8 h) sin(alpha / 2) of acceleration; where the way turns back, it comes to rest.
/// - No angle turns faster than its fastest leg; a turn on the spot by beta at most 15 v beta / (16 h).
///
/// What the legs change in all must be a whole number of turns of yaw, else the way would jump from its end to its
/// start.
class SmoothedWay {
 public:
  /// At most half a period of rounding. Throws ConfigError where the legs lead nowhere.
  SmoothedWay(const PoseVector& start, std::vector<Leg> legs, double rounding_m);

  /// `way_m` from the start; any number.
  PoseVector at(double way_m) const;
  double period_m() const { return end_m_.back(); }

 private:
  PoseVector start_;
  std::vector<Leg> legs_;
  std::vector<double> end_m_;       ///< way to the end of each leg
  std::vector<PoseVector> before_;  ///< change of all legs before each, and of all at last
  double half_m_;
};

/// From the first knot to the last and back, for ever; at rest at both. Yaw is taken as it stands. Where the first or
/// last leg is shorter than the rounding, the end is not quite reached.
SmoothedWay there_and_back(const std::vector<PoseVector>& knots, double rounding_m);
/// Round and round: from the last knot on to the first. Angles between neighbours turn the short way.
SmoothedWay round_and_round(const std::vector<PoseVector>& knots, double rounding_m);

/// Turns every angle the short way from knot to knot, by adding whole turns.
std::vector<PoseVector> unwrapped(std::vector<PoseVector> knots);

}  // namespace ensonify
