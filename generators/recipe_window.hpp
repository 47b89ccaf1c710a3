#pragma once

#include "ensonify/config/reader.hpp"
#include "ensonify/generators/recipe.hpp"

namespace ensonify {

/// Throws ConfigError, naming the line of `sonar` in the recipe's file, where a frame could have a range window that
/// the instrument can not be set to.
void check_window(const Reader& sonar, const Recipe& recipe);

}  // namespace ensonify
