#pragma once

#include <cstddef>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

struct Welded {
  TriangleMesh mesh;
  std::size_t dropped = 0;  ///< triangles without area or with a coordinate that is not finite or beyond 1e6 m
};

/// Joins vertices of equal coordinates and drops unusable triangles and unused vertices. Keeps the order.
Welded weld(const TriangleMesh& mesh);

}  // namespace ensonify
