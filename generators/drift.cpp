#include "ensonify/generators/drift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

/// Standard Brownian motion at `time_s`: the walk at the horizon is drawn, then midpoints are filled in, halving the
/// interval about time_s until it is an eighth of a second; the numbers are addressed by level and place.
double brownian(RandomKey key, double time_s) {
  constexpr double horizon_s = longest_drift_s;
  constexpr int levels = 20;
  double left_s = 0.0;
  double right_s = horizon_s;
  double left = 0.0;
  double right = std::sqrt(horizon_s) * normal_at(key, 0);
  std::uint64_t node = 1;  // heap order: children of k are 2k and 2k + 1
  for (int level = 0; level < levels; ++level) {
    const double middle_s = 0.5 * (left_s + right_s);
    const double middle = 0.5 * (left + right) + 0.5 * std::sqrt(right_s - left_s) * normal_at(key, node);
    const bool later = time_s >= middle_s;
    (later ? left_s : right_s) = middle_s;
    (later ? left : right) = middle;
    node = 2 * node + (later ? 1 : 0);
  }
  return left + (right - left) * (std::clamp(time_s, left_s, right_s) - left_s) / (right_s - left_s);
}

}  // namespace

Eigen::Vector2d drift_m(const Drift& drift, RandomKey key, double time_s) {
  // The mean of a Rayleigh radius is sigma sqrt(pi / 2).
  const double sigma_m = drift.radial_error_m / std::sqrt(std::numbers::pi / 2.0);
  const double share = sigma_m * std::sqrt(0.5);
  Eigen::Vector2d error;
  for (int axis = 0; axis < 2; ++axis) {
    const RandomKey axis_key = key.child(static_cast<std::uint64_t>(axis));
    const double bias = normal_at(axis_key.child("bias"), 0) * time_s / drift.after_s;
    const double walk = brownian(axis_key.child("walk"), time_s) / std::sqrt(drift.after_s);
    error[axis] = share * (bias + walk);
  }
  return error;
}

Pose drifted(const Pose& T_world_sonar, const Drift& drift, RandomKey key, double time_s) {
  Pose estimate = T_world_sonar;
  estimate.translation().head<2>() += drift_m(drift, key, time_s);
  return estimate;
}

}  // namespace ensonify
