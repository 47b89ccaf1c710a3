#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// Indices of a cell along x, y, z; may lie outside the grid.
using Cell = std::array<int, 3>;

/// Cells that lines may name: farther ones would overflow the integers of a traversal.
constexpr int farthest_cell = 1 << 29;

/// Cells with low <= index < high on each axis.
struct CellBox {
  Cell low{};
  Cell high{};

  bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
  bool contains(const Cell& c) const {
    return c[0] >= low[0] && c[1] >= low[1] && c[2] >= low[2] && c[0] < high[0] && c[1] < high[1] && c[2] < high[2];
  }
  bool operator==(const CellBox&) const = default;
};

inline CellBox box_of(const GridFrame& frame) { return {{}, frame.size}; }

inline CellBox intersection(const CellBox& a, const CellBox& b) {
  CellBox both;
  for (int i = 0; i < 3; ++i) {
    both.low[i] = std::max(a.low[i], b.low[i]);
    both.high[i] = std::max(both.low[i], std::min(a.high[i], b.high[i]));
  }
  return both;
}

/// A box of cells in memory: cell c lies at sum stride[a] (c[a] - first[a]).
struct StridedBox {
  CellBox box;
  Cell first{};
  std::array<std::ptrdiff_t, 3> stride{};

  std::ptrdiff_t offset(const Cell& c) const {
    return stride[0] * (c[0] - first[0]) + stride[1] * (c[1] - first[1]) + stride[2] * (c[2] - first[2]);
  }
};

}  // namespace ensonify
