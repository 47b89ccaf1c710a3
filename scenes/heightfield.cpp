#include "ensonify/scenes/heightfield.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

using Index = std::uint32_t;

/// Grid nodes of the border, counter-clockwise seen from above.
std::vector<Index> border_nodes(int columns, int rows) {
  std::vector<Index> border;
  const auto add = [&](int column, int row) { border.push_back(static_cast<Index>(row * columns + column)); };
  for (int c = 0; c + 1 < columns; ++c) add(c, 0);
  for (int r = 0; r + 1 < rows; ++r) add(columns - 1, r);
  for (int c = columns - 1; c > 0; --c) add(c, rows - 1);
  for (int r = rows - 1; r > 0; --r) add(0, r);
  return border;
}

}  // namespace

double HeightGrid::at(double x_m, double y_m) const {
  const double u = std::clamp((x_m - origin_m.x()) / spacing_m.x(), 0.0, height_m.columns() - 1.0);
  const double v = std::clamp((y_m - origin_m.y()) / spacing_m.y(), 0.0, height_m.rows() - 1.0);
  const int c = std::min(static_cast<int>(u), height_m.columns() - 2);
  const int r = std::min(static_cast<int>(v), height_m.rows() - 2);
  const double fu = u - c, fv = v - r;
  return (1 - fv) * ((1 - fu) * height_m(r, c) + fu * height_m(r, c + 1)) +
         fv * ((1 - fu) * height_m(r + 1, c) + fu * height_m(r + 1, c + 1));
}

HeightGrid sample_terrain(const Terrain& terrain, RandomKey key, const Eigen::AlignedBox2d& area_m, double spacing_m) {
  const Eigen::Vector2d size = area_m.sizes();
  const int columns = std::max(1, static_cast<int>(std::ceil(size.x() / spacing_m - 1e-9))) + 1;
  const int rows = std::max(1, static_cast<int>(std::ceil(size.y() / spacing_m - 1e-9))) + 1;
  HeightGrid grid{area_m.min(), {size.x() / (columns - 1), size.y() / (rows - 1)}, Image2<float>(rows, columns)};
  parallel_for(rows, [&](int r) {
    for (int c = 0; c < columns; ++c) {
      grid.height_m(r, c) = static_cast<float>(terrain_height_m(
          terrain, key, grid.origin_m.x() + c * grid.spacing_m.x(), grid.origin_m.y() + r * grid.spacing_m.y()));
    }
  });
  return grid;
}

TriangleMesh sheet_mesh(const HeightGrid& grid, bool facing_up) {
  const int columns = grid.height_m.columns(), rows = grid.height_m.rows();
  TriangleMesh mesh;
  mesh.vertices_m.reserve(grid.height_m.size());
  mesh.triangles.reserve(2 * grid.height_m.size());
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.vertices_m.emplace_back(static_cast<float>(grid.origin_m.x() + c * grid.spacing_m.x()),
                                   static_cast<float>(grid.origin_m.y() + r * grid.spacing_m.y()), grid.height_m(r, c));
    }
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const Index a = static_cast<Index>(r * columns + c), b = a + 1;
      const Index d = a + static_cast<Index>(columns), e = d + 1;
      mesh.triangles.push_back({a, b, e});
      mesh.triangles.push_back({a, e, d});
    }
  }
  if (!facing_up) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

TriangleMesh slab_mesh(const HeightGrid& grid, double thickness_m) {
  TriangleMesh mesh = sheet_mesh(grid, true);
  const auto heights = grid.height_m.pixels();
  const float bottom = *std::min_element(heights.begin(), heights.end()) - static_cast<float>(thickness_m);

  const std::vector<Index> border = border_nodes(grid.height_m.columns(), grid.height_m.rows());
  const Index n = static_cast<Index>(border.size());
  const Index ring = static_cast<Index>(mesh.vertices_m.size());
  Eigen::Vector3f centre = 0.5f * (mesh.vertices_m.front() + mesh.vertices_m.back());
  centre.z() = bottom;
  for (const Index node : border) {
    const Eigen::Vector3f top = mesh.vertices_m[node];
    mesh.vertices_m.emplace_back(top.x(), top.y(), bottom);
  }
  const Index middle = ring + n;
  mesh.vertices_m.push_back(centre);
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    mesh.triangles.push_back({border[i], ring + i, ring + j});
    mesh.triangles.push_back({border[i], ring + j, border[j]});
    mesh.triangles.push_back({middle, ring + j, ring + i});
  }
  return mesh;
}

}  // namespace ensonify
