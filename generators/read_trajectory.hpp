#pragma once

#include "ensonify/config/reader.hpp"
#include "ensonify/generators/trajectory_spec.hpp"

namespace ensonify {

/// Reads the mapping `trajectory` of a split, and the TUM file that it may name, relative to the recipe.
/// Throws ConfigError, and DataError where the TUM file breaks a rule.
TrajectoryPoses read_trajectory(Reader trajectory);

}  // namespace ensonify
