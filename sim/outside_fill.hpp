#pragma once

#include "ensonify/sim/bit_grid.hpp"

namespace ensonify {

/// Cells that can not be reached from the rim of the box (one layer, taken as outside) through faces of cells that are
/// not `walls`, walls themselves excepted: what a shell encloses. Leaks through any gap that a cell fits into.
BitGrid enclosed_by(const BitGrid& walls);

}  // namespace ensonify
