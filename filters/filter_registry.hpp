#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/filters/filter_method.hpp"

namespace ensonify {

struct ParameterInfo {
  std::string name, otherwise, rule, unit, about;
};

struct MethodInfo {
  std::string name, source;
  FilterRole role;
  std::vector<ParameterInfo> parameters;
  bool ready = true;  ///< works with its defaults: no parameter must be given
};

/// Every method with its parameters, in the order of `FilterMethod`.
std::vector<MethodInfo> filter_methods();
MethodInfo method_info(const FilterMethod& method);

/// The method of that name with its defaults. Throws ConfigError naming the nearest.
FilterStep make_filter(const std::string& name);

/// What is wrong with that value for that parameter of the step, or nothing, and the parameter is set.
std::string set_parameter(FilterStep& step, const std::string& parameter, const std::string& value);

/// "key=value" as on the command line. Throws ConfigError: no such parameter (the nearest is named), or a value against
/// its rule.
void assign_parameter(FilterStep& step, const std::string& assignment);

/// Throws ConfigError where parameters do not go together or one is missing, DataError where a model is broken.
void check_filter(const FilterStep& step);

/// Every parameter and its value, exact: set_parameter() makes the same step of them. Optional ones only where they are
/// set.
std::vector<std::pair<std::string, std::string>> parameter_values(const FilterStep& step);

}  // namespace ensonify
