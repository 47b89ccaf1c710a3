#include "ensonify/generators/smoothed_way.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;
/// Mean of |u| under the kernel, over h: how far a way that turns back falls short of its end.
constexpr double mean_reach = 5.0 / 16.0;

/// A step at 0, smoothed by the kernel of half-width h; v = x / h.
double smooth_step(double v) {
  if (v <= -1.0) return 0.0;
  if (v >= 1.0) return 1.0;
  const double v2 = v * v;
  return 0.5 + 15.0 / 16.0 * v * (1.0 - v2 * (2.0 / 3.0 - v2 / 5.0));
}

/// max(0, x) / h, smoothed: the integral of smooth_step.
double smooth_hinge(double v) {
  if (v <= -1.0) return 0.0;
  if (v >= 1.0) return v;
  const double v2 = v * v;
  return 5.0 / 32.0 + 0.5 * v + 15.0 / 16.0 * v2 * (0.5 - v2 * (1.0 / 6.0 - v2 / 30.0));
}

/// Share of a leg done at x behind its start, smoothed.
double smooth_share(double x_m, double length_m, double half_m) {
  constexpr double jump = 1e-6;  // below it the difference of hinges loses its digits
  if (length_m < jump * half_m) return smooth_step((x_m - 0.5 * length_m) / half_m);
  return (smooth_hinge(x_m / half_m) - smooth_hinge((x_m - length_m) / half_m)) * half_m / length_m;
}

Leg leg_between(const PoseVector& from, const PoseVector& to) { return {(to - from).head<3>().norm(), to - from}; }

/// A leg straight on from `outward`, out and in again, as far as the rounding falls short.
void add_overshoot(std::vector<Leg>& legs, Leg outward, double rounding_m) {
  if (outward.length_m < rounding_m) return;
  Leg out{mean_reach * rounding_m, PoseVector::Zero()};
  out.change.head<3>() = outward.change.head<3>() * (out.length_m / outward.length_m);
  legs.push_back(out);
  legs.push_back({out.length_m, -out.change});
}

double way_through_m(const std::vector<PoseVector>& knots) {
  double way_m = 0;
  for (std::size_t i = 1; i < knots.size(); ++i) way_m += leg_between(knots[i - 1], knots[i]).length_m;
  if (way_m <= 0.0) throw ConfigError("a trajectory needs at least two waypoints at different places");
  return way_m;
}

}  // namespace

Pose pose_of(const PoseVector& v) { return pose_from_xyz_rpy(v.head<3>(), v[3], v[4], v[5]); }

PoseVector vector_of(const Pose& pose) {
  const auto [roll, pitch, yaw] = roll_pitch_yaw(pose);
  PoseVector vector;
  vector << pose.translation(), roll, pitch, yaw;
  return vector;
}

SmoothedWay::SmoothedWay(const PoseVector& start, std::vector<Leg> legs, double rounding_m)
    : start_(start), legs_(std::move(legs)) {
  double way_m = 0;
  before_.push_back(PoseVector::Zero());
  for (const Leg& leg : legs_) {
    end_m_.push_back(way_m += leg.length_m);
    before_.push_back(before_.back() + leg.change);
  }
  if (way_m <= 0.0) throw ConfigError("a trajectory needs at least two waypoints at different places");
  half_m_ = std::min(rounding_m, 0.5 * way_m);
}

PoseVector SmoothedWay::at(double way_m) const {
  const double s = way_m - period_m() * std::floor(way_m / period_m());
  // Legs wholly before the window count in full; from the first that reaches into it on, each by its share.
  double shift_m = s < half_m_ ? -period_m() : 0.0;
  const auto first = std::upper_bound(end_m_.begin(), end_m_.end() - 1, s - half_m_ - shift_m);
  auto leg = static_cast<std::size_t>(first - end_m_.begin());
  PoseVector value = start_ + before_[leg];
  if (shift_m < 0.0) value -= before_.back();
  while (true) {
    const double begin_m = shift_m + (leg == 0 ? 0.0 : end_m_[leg - 1]);
    if (begin_m > s + half_m_) break;
    value += legs_[leg].change * smooth_share(s - begin_m, legs_[leg].length_m, half_m_);
    if (++leg == legs_.size()) {
      leg = 0;
      shift_m += period_m();
    }
  }
  return value;
}

SmoothedWay there_and_back(const std::vector<PoseVector>& knots, double rounding_m) {
  const double half_m = std::min(rounding_m, 0.25 * way_through_m(knots));
  std::vector<Leg> legs;
  for (std::size_t i = 1; i < knots.size(); ++i) legs.push_back(leg_between(knots[i - 1], knots[i]));
  add_overshoot(legs, legs.back(), half_m);
  for (std::size_t i = knots.size() - 1; i > 0; --i) legs.push_back(leg_between(knots[i], knots[i - 1]));
  const std::size_t before = legs.size();
  add_overshoot(legs, legs.back(), half_m);
  // The way begins where it comes to rest: half of the overshoot at the start lies before it.
  PoseVector start = knots.front();
  if (legs.size() > before) {
    start += legs[before].change;
    std::rotate(legs.begin(), legs.end() - 1, legs.end());
  }
  return SmoothedWay(start, std::move(legs), half_m);
}

SmoothedWay round_and_round(const std::vector<PoseVector>& knots, double rounding_m) {
  const double half_m = std::min(rounding_m, 0.25 * way_through_m(knots));
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    Leg leg = leg_between(knots[i], knots[(i + 1) % knots.size()]);
    for (int angle = 3; angle < 6; ++angle) leg.change[angle] = std::remainder(leg.change[angle], full_turn);
    legs.push_back(leg);
  }
  return SmoothedWay(knots.front(), std::move(legs), half_m);
}

std::vector<PoseVector> unwrapped(std::vector<PoseVector> knots) {
  for (std::size_t i = 1; i < knots.size(); ++i) {
    for (int angle = 3; angle < 6; ++angle) {
      knots[i][angle] = knots[i - 1][angle] + std::remainder(knots[i][angle] - knots[i - 1][angle], full_turn);
    }
  }
  return knots;
}

}  // namespace ensonify
