#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ensonify/core/pose.hpp"
#include "ensonify/sim/bit_grid.hpp"

namespace ensonify {

/// Which cell centres lie inside a mesh.
struct ParityVote {
  BitGrid inside;        ///< at least two of the three axes say so
  BitGrid disagreement;  ///< the three axes do not agree
};

/// Counts the triangles that a line from outside along x, y and z to each cell centre passes: odd = inside (the
/// orientation of the triangles does not matter), majority of the three. Vertices in cells of the grid; the result
/// covers the box `low`, `size`. A centre exactly on an edge or a corner belongs to exactly one side: the rows of a
/// projected triangle are half-open and the same edge cuts a row at the same bits whichever triangle it is seen from,
/// so that a mesh whose edges are all shared by an even number of triangles shows no stripes.
ParityVote vote_parity(std::span<const Vec3> vertices_cells, std::span<const std::array<std::uint32_t, 3>> triangles,
                       const std::array<int, 3>& low, const std::array<int, 3>& size);

}  // namespace ensonify
