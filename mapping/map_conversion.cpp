#include "ensonify/mapping/map_conversion.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

template <typename Visit>
void for_each_cell(const GridFrame& frame, const Visit& visit) {
  for (int z = 0; z < frame.size[2]; ++z) {
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = 0; x < frame.size[0]; ++x) visit(Cell{x, y, z}, frame.index(x, y, z));
    }
  }
}

}  // namespace

LogOddsMap dense_map(const LogOddsGrid& grid) {
  LogOddsMap map{grid.frame(), std::vector<float>(grid.frame().cells())};
  for_each_cell(map.frame,
                [&](const Cell& cell, std::size_t i) { map.log_odds[i] = static_cast<float>(1e-3 * grid.at(cell)); });
  return map;
}

LogOddsGrid grid_of(const LogOddsMap& map, const LogOddsLimits& limits) {
  LogOddsGrid grid(map.frame, limits);
  if (map.log_odds.size() != map.frame.cells()) {
    throw ConfigError(
        fmt::format("map with {} values for {} cells; it needs one a cell", map.log_odds.size(), map.frame.cells()));
  }
  for_each_cell(map.frame, [&](const Cell& cell, std::size_t i) {
    const double milli = 1e3 * static_cast<double>(map.log_odds[i]);
    if (std::isnan(milli)) {
      throw DataError(
          fmt::format("log-odds of cell ({}, {}, {}) is no number; unknown cells hold 0", cell[0], cell[1], cell[2]));
    }
    if (milli != 0)
      grid.set(cell, static_cast<MilliLogOdds>(std::round(std::clamp<double>(milli, limits.lowest, limits.highest))));
  });
  return grid;
}

}  // namespace ensonify
