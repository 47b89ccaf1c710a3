#pragma once

#include <vector>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// What a mapper believes, as a dense array: natural log-odds, positive = OCCUPIED, 0 = unknown; one a cell in the
/// order of GridFrame::index.
struct LogOddsMap {
  GridFrame frame;
  std::vector<float> log_odds;
};

}  // namespace ensonify
