#pragma once

#include <Eigen/Geometry>

#include "ensonify/core/image2.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/scenes/mesh.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {

/// Heights on a regular grid: row = y, column = x, node (0, 0) at `origin_m`.
struct HeightGrid {
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d spacing_m = Eigen::Vector2d::Ones();
  Image2<float> height_m;

  bool empty() const { return height_m.empty(); }
  /// Bilinear height; outside, that of the nearest border. Not for an empty grid.
  double at(double x_m, double y_m) const;
};

/// Samples a terrain over an area at no more than `spacing_m` between nodes, at least 2 x 2 nodes.
HeightGrid sample_terrain(const Terrain& terrain, RandomKey key, const Eigen::AlignedBox2d& area_m, double spacing_m);

/// Closed block: the heights on top, a skirt, and a flat bottom `thickness_m` below the lowest height.
TriangleMesh slab_mesh(const HeightGrid& grid, double thickness_m);
/// Open sheet; `facing_up` chooses the side that is seen.
TriangleMesh sheet_mesh(const HeightGrid& grid, bool facing_up);

}  // namespace ensonify
