#include "ensonify/filters/filter_grid.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/filter_registry.hpp"

namespace ensonify {
namespace {

constexpr std::size_t most_steps = 1000;

bool goes_together(const FilterStep& step) {
  try {
    check_filter(step);
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

}  // namespace

std::vector<FilterGrid> load_filter_grid(const std::string& path_or_name) {
  Reader file = Reader::from_file(resolve_name("filters/tuning", path_or_name));
  file.text("name");
  file.text_or("about", "");
  Reader methods = file.child("methods");
  std::vector<FilterGrid> grids;
  for (const std::string& method : methods.keys()) {
    Reader parameters = methods.child(method);
    FilterGrid grid{method, {make_filter(method)}};
    for (const std::string& parameter : parameters.keys()) {
      std::vector<FilterStep> wider;
      for (const std::string& value : parameters.texts(parameter)) {
        for (FilterStep step : grid.steps) {
          const std::string fault = set_parameter(step, parameter, value);
          if (!fault.empty()) parameters.fail(parameter, fault);
          wider.push_back(step);
        }
      }
      if (wider.size() > most_steps)
        parameters.fail(parameter, fmt::format("at most {} combinations a method", most_steps));
      grid.steps = std::move(wider);
    }
    parameters.finish();
    std::erase_if(grid.steps, [](const FilterStep& step) { return !goes_together(step); });
    grids.push_back(std::move(grid));
  }
  methods.finish();
  file.finish();
  return grids;
}

std::string preset_yaml(const std::string& name, const std::string& about, const std::vector<FilterStep>& steps) {
  std::string text = fmt::format("name: {}\nabout: {}\nmethods:\n", name, about);
  for (const FilterStep& step : steps) {
    const auto defaults = parameter_values(make_filter(name_of(step.method)));
    std::string chosen;
    for (const auto& value : parameter_values(step)) {
      if (std::ranges::find(defaults, value) != defaults.end()) continue;
      chosen += fmt::format("{}{}: {}", chosen.empty() ? "" : ", ", value.first, value.second);
    }
    text += fmt::format("  {}: {{{}}}\n", name_of(step.method), chosen);
  }
  return text;
}

}  // namespace ensonify
