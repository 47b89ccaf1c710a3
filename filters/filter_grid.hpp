#pragma once

#include <string>
#include <vector>

#include "ensonify/filters/filter_method.hpp"

namespace ensonify {

/// Settings of one method that are to be compared.
struct FilterGrid {
  std::string method;
  std::vector<FilterStep> steps;  ///< every combination of the values listed
};

/// Loads a grid (path or bundled name): the key `methods` holds a mapping a method, and that a list of values a
/// parameter. Combinations that do not go together are left out. Throws ConfigError.
std::vector<FilterGrid> load_filter_grid(const std::string& path_or_name);

/// A preset as YAML text, as load_filter_preset reads it: what differs from the defaults.
std::string preset_yaml(const std::string& name, const std::string& about, const std::vector<FilterStep>& steps);

}  // namespace ensonify
