#pragma once

#include <vector>

#include "ensonify/mapping/cell_box.hpp"

namespace ensonify {

/// A piece of a box of cells, to be mapped by itself.
struct MapPart {
  GridFrame frame;  ///< the piece and a margin around it, within the box
  CellBox core;     ///< the piece, as indices of `frame`
};

/// Slabs along x that take at most `limit_bytes` each at `bytes_a_cell`, with `margin` cells more on both sides. Throws
/// ConfigError where not even the thinnest does.
std::vector<MapPart> parts_of(const GridFrame& box, int margin, double bytes_a_cell, double limit_bytes);

/// The box of cells of a grid, as a frame.
GridFrame part_of(const GridFrame& frame, const CellBox& box);

/// The cells of a box of a grid.
OccupancyGrid cropped(const OccupancyGrid& grid, const CellBox& box);

/// The box of cells where `observable` is set; empty where none is.
CellBox observable_box(const OccupancyGrid& grid);

/// The smallest box that holds both.
CellBox hull(const CellBox& a, const CellBox& b);

}  // namespace ensonify
