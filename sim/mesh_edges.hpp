#pragma once

#include <cstddef>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// How well a mesh closes.
struct EdgeCount {
  std::size_t open = 0;         ///< edges of one triangle only
  std::size_t nonmanifold = 0;  ///< edges of more than two triangles
  std::size_t odd = 0;          ///< edges of an odd number of triangles: a border
  std::size_t unlike = 0;       ///< edges of two triangles that pass them the same way: one of the two is turned over
  bool watertight() const { return odd == 0; }
};

/// Edges are told apart by the positions of their ends, so that vertices a file repeats count as one.
/// Edges of no length are left out. Triangle indices must be valid.
EdgeCount count_edges(const TriangleMesh& mesh);

}  // namespace ensonify
