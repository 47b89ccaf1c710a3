#pragma once

#include "ensonify/core/pose.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/generators/recipe.hpp"

namespace ensonify {

inline constexpr double longest_drift_s = 131072.0;  ///< 36 hours

/// Position error (m; east, north) of dead reckoning `time_s` after its start: half the variance at drift.after_s
/// comes from a constant velocity bias (linear in time), half from velocity noise (a Brownian walk). Each axis is
/// normal, so the radius is Rayleigh, and its mean at after_s is drift.radial_error_m. Depth and attitude are taken as
/// measured. A pure function: any time can be asked for alone (Brownian motion by Levy's midpoint construction).
/// Limits: time_s in [0, longest_drift_s].
Eigen::Vector2d drift_m(const Drift& drift, RandomKey key, double time_s);

/// T_world_sonar as dead reckoning believes it.
Pose drifted(const Pose& T_world_sonar, const Drift& drift, RandomKey key, double time_s);

}  // namespace ensonify
