#include "ensonify/generators/recipe_window.hpp"

#include <fmt/format.h>

#include <variant>
#include <vector>

#include "ensonify/core/error.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

void check_window(const Reader& sonar, const Recipe& recipe) {
  const SonarModel instrument = load_sonar(recipe.sonar);
  const double begin_m = recipe.range_min_m.value_or(instrument.geometry.range_min_m);
  const std::string rule = fmt::format("must lie within the {} to {} m of {}", instrument.instrument_range_min_m,
                                       instrument.instrument_range_max_m, instrument.name);
  if (begin_m < instrument.instrument_range_min_m) sonar.fail("range_min_m", fmt::format("{}, not {}", rule, begin_m));
  std::vector<RangeWindow> windows;
  if (recipe.range_max_m) {
    const Limits ends = ends_of(*recipe.range_max_m);
    for (const double end_m : {ends.low, ends.high}) {
      if (end_m > instrument.instrument_range_max_m) {
        sonar.fail("range_max_m", fmt::format("{}, not {}", rule, end_m));
      }
      if (end_m <= begin_m) {
        sonar.fail("range_max_m",
                   fmt::format("can be {} m, where the window begins at {} m; it must end beyond", end_m, begin_m));
      }
      windows.push_back({recipe.range_min_m, end_m, recipe.range_bins});
    }
  }
  if (!recipe.range_max_m || !std::holds_alternative<Constant>(*recipe.range_max_m)) {
    // A set whose windows differ is described by the instrument's own.
    if (begin_m >= instrument.geometry.range_max_m) {
      sonar.fail("range_min_m", fmt::format("must lie below the {} m that the window of {} ends at, not {}",
                                            instrument.geometry.range_max_m, instrument.name, begin_m));
    }
    windows.push_back({recipe.range_min_m, {}, recipe.range_bins});
  }
  for (const RangeWindow& window : windows) {
    try {
      load_sonar(recipe.sonar, window);
    } catch (const ConfigError& e) {
      sonar.fail(recipe.range_bins ? "range_bins" : "range_max_m", e.what());
    }
  }
}

}  // namespace ensonify
