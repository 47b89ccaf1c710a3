#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// What a mapper believes, as a dense array: natural log-odds, positive = OCCUPIED, 0 = unknown; one a cell in the
/// order of GridFrame::index.
struct LogOddsMap {
  GridFrame frame;
  std::vector<float> log_odds;
};

inline bool is_finite(const LogOddsMap& map) {
  return std::ranges::all_of(map.log_odds, [](float v) { return std::isfinite(v); });
}

/// For writers of grids: positive is `surface`, all else `free`; observable where the value is not 0, so that unknown
/// cells are those that nothing observed.
inline OccupancyGrid occupancy_of(const LogOddsMap& map) {
  OccupancyGrid grid{map.frame, std::vector<std::uint8_t>(map.log_odds.size()),
                     std::vector<std::uint8_t>(map.log_odds.size())};
  for (std::size_t i = 0; i < map.log_odds.size(); ++i) {
    grid.occupancy[i] = static_cast<std::uint8_t>(map.log_odds[i] > 0 ? Occupancy::surface : Occupancy::free);
    grid.observable[i] = map.log_odds[i] != 0;
  }
  return grid;
}

}  // namespace ensonify
