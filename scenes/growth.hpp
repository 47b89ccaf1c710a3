#pragma once

#include <cstddef>
#include <stdexcept>

#include "ensonify/core/random.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// Marine growth: mussels, barnacles and weed as bumps on a surface.
struct Growth {
  double thickness_m = 0.03;  ///< greatest
  double patch_m = 0.2;       ///< size of the bumps
  double coverage = 1;        ///< share of the surface that is overgrown, about
};

/// More triangles than a grown object may have.
class GrowthTooFine : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
constexpr std::size_t max_grown_triangles = 1'000'000;

/// Cuts triangles until their sides are about `edge_m` at most, none above 1.5 times that. Triangles that share an edge
/// share the points on it, so what was closed stays closed. Throws GrowthTooFine beyond `most` triangles.
TriangleMesh split_long_edges(const TriangleMesh& mesh, double edge_m, std::size_t most);

/// Moves every vertex outward, along the mean normal of its triangles weighted by their area, by 0 to the thickness.
/// Noise is a function of the place, so vertices that coincide move alike. Welds first.
TriangleMesh overgrow(const TriangleMesh& mesh, const Growth& growth, RandomKey key, std::size_t most);

/// The same for every part of an object, whose noise runs on from part to part. Parts become meshes of their own: each
/// has its place, and so its own growth. Unchanged where the thickness or the coverage is 0.
Assembly overgrow(const Assembly& assembly, const Growth& growth, RandomKey key);

}  // namespace ensonify
