#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ensonify/core/pose.hpp"
#include "ensonify/sim/bit_grid.hpp"

namespace ensonify {

/// A cell counts as touched up to this far outside of it, and a face that keeps this close to a border of cells lies on
/// it (cells), however its vertices were rounded.
constexpr double surface_margin_cells = 1.0 / 1024;

/// Sets every cell of `surface` that a triangle touches (conservative: separating axes of triangle and box, in the form
/// of Schwarz and Seidel 2010: three 2-D projections and the plane). Vertices in cells of the grid. Cells on the rim
/// of the box, one layer thick, stay unset. Degenerate triangles mark what their points and edges touch. A face on the
/// border of two layers of cells, as walls of round measures have, marks only the layer behind it (its normal points
/// out): the water before it stays free.
void mark_surface(std::span<const Vec3> vertices_cells, std::span<const std::array<std::uint32_t, 3>> triangles,
                  BitGrid& surface);

}  // namespace ensonify
