#pragma once

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

/// The map as a dense array in natural log-odds (1e-3 of the integers), 4 bytes a cell.
LogOddsMap dense_map(const LogOddsGrid& grid);

/// A grid with the nearest integers, within the limits. Throws ConfigError for a frame that LogOddsGrid refuses or a
/// number of values that does not fit it; DataError for a value that is no number.
LogOddsGrid grid_of(const LogOddsMap& map, const LogOddsLimits& limits = {});

}  // namespace ensonify
