#pragma once

#include <cstddef>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// Single precision holds no shape further out: a step there is 6 cm.
constexpr float weld_reach_m = 1e6f;

struct Welded {
  TriangleMesh mesh;
  std::size_t flat = 0;          ///< triangles dropped because they have no area
  std::size_t out_of_reach = 0;  ///< dropped because a coordinate is not finite or beyond weld_reach_m
};

/// Joins vertices of equal coordinates and drops unusable triangles and unused vertices. Keeps the order.
Welded weld(const TriangleMesh& mesh);

}  // namespace ensonify
