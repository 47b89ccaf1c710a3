#include "ensonify/sim/voxel_surface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

/// p * m_p + q * m_q + k is below 0 for cell indices (p, q) where the cell's square is wholly outside of this edge.
struct EdgeTest {
  double m_p, m_q, k;
  double value(double p, double q) const { return m_p * p + m_q * q + k; }
};

/// The three edges of a triangle seen along the axis that is neither p nor q.
template <int p, int q>
std::array<EdgeTest, 3> edge_tests(const std::array<Vec3, 3>& corner, double half_cell) {
  const double area = (corner[1][p] - corner[0][p]) * (corner[2][q] - corner[0][q]) -
                      (corner[1][q] - corner[0][q]) * (corner[2][p] - corner[0][p]);
  const double sign = area < 0 ? -1.0 : 1.0;
  std::array<EdgeTest, 3> tests;
  for (int i = 0; i < 3; ++i) {
    const Vec3& from = corner[i];
    const Vec3& to = corner[(i + 1) % 3];
    const double m_p = -sign * (to[q] - from[q]);
    const double m_q = sign * (to[p] - from[p]);
    // 0.5 takes the index of a cell to its centre.
    const double k = m_p * (0.5 - from[p]) + m_q * (0.5 - from[q]) + half_cell * (std::abs(m_p) + std::abs(m_q));
    tests[i] = {m_p, m_q, k};
  }
  return tests;
}

bool pass_all(const std::array<EdgeTest, 3>& tests, double p, double q) {
  // One branch for three: which of them fails is a toss-up, and a wrong guess costs more than the arithmetic.
  return std::min({tests[0].value(p, q), tests[1].value(p, q), tests[2].value(p, q)}) >= 0;
}

/// Largest component of the normal: along it the triangle is thinnest.
int dominant_axis(const Vec3& n) {
  const Vec3 a = n.cwiseAbs();
  if (a.x() >= a.y() && a.x() >= a.z()) return 0;
  return a.y() >= a.z() ? 1 : 2;
}

/// False for slivers whose rounded normal could turn the plane away from their own points by a part of the margin;
/// for those the edges alone decide.
bool normal_is_sure(const std::array<Vec3, 3>& corner, const Vec3& n) {
  const double reach = std::max(
      {corner[0].cwiseAbs().maxCoeff(), corner[1].cwiseAbs().maxCoeff(), corner[2].cwiseAbs().maxCoeff(), 1.0});
  return n.cwiseAbs().maxCoeff() > 1e-11 * reach * reach * reach;
}

using Cell = std::array<int, 3>;

/// Marks the cells of the block first .. first + extent - 1 that the triangle touches, by columns along axis w, the
/// dominant one of the normal n. Corners relative to the block.
template <int w>
void mark_by_columns(const std::array<Vec3, 3>& corner, const Vec3& n, double margin, const Cell& first,
                     const Cell& extent, BitGrid& surface) {
  constexpr int u = (w + 1) % 3;
  constexpr int v = (w + 2) % 3;
  const double half_cell = 0.5 + margin;
  const auto tests_uv = edge_tests<u, v>(corner, half_cell);
  const auto tests_vw = edge_tests<v, w>(corner, half_cell);
  const auto tests_wu = edge_tests<w, u>(corner, half_cell);

  const bool has_plane = normal_is_sure(corner, n);
  const double inverse = has_plane ? 1.0 / n[w] : 0.0;
  const double slope_u = -n[u] * inverse;
  const double slope_v = -n[v] * inverse;
  const double reach = half_cell * (std::abs(slope_u) + std::abs(slope_v)) + margin;
  const double base = corner[0][w] + slope_u * (0.5 - corner[0][u]) + slope_v * (0.5 - corner[0][v]);

  for (int iv = 0; iv < extent[v]; ++iv) {
    for (int iu = 0; iu < extent[u]; ++iu) {
      if (!pass_all(tests_uv, iu, iv)) continue;
      int begin = 0;
      int end = extent[w] - 1;
      if (has_plane) {
        const double plane = base + slope_u * iu + slope_v * iv;
        begin = static_cast<int>(std::floor(std::clamp(plane - reach, 0.0, 1.0 * extent[w])));
        end = static_cast<int>(std::floor(std::clamp(plane + reach, -1.0, extent[w] - 1.0)));
      }
      for (int iw = begin; iw <= end; ++iw) {
        if (!pass_all(tests_vw, iv, iw) || !pass_all(tests_wu, iw, iu)) continue;
        Cell c = first;
        c[u] += iu;
        c[v] += iv;
        c[w] += iw;
        surface.set(c[0], c[1], c[2]);
      }
    }
  }
}

/// Marks what the triangle touches of cells that are wider by `margin` on every side.
void mark_touched(std::array<Vec3, 3> corner, double margin, BitGrid& surface) {
  Cell first;
  Cell extent;
  int thin_axes = 0;
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({corner[0][a], corner[1][a], corner[2][a]});
    const double from_whole = std::floor(low - surface.low[a] - margin);
    const double to_whole = std::floor(high - surface.low[a] + margin);
    const double from = std::max(from_whole, 1.0);
    const double to = std::min(to_whole, surface.size[a] - 2.0);
    if (!(from <= to)) return;
    thin_axes += from_whole == to_whole;
    first[a] = static_cast<int>(from);
    extent[a] = static_cast<int>(to) - first[a] + 1;
    for (Vec3& c : corner) c[a] -= surface.low[a] + first[a];
  }
  // Inside a single row of cells a connected thing touches every cell between its ends.
  if (thin_axes < 2) {
    const Vec3 n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const int w = dominant_axis(n);
    if (w == 0) return mark_by_columns<0>(corner, n, margin, first, extent, surface);
    if (w == 1) return mark_by_columns<1>(corner, n, margin, first, extent, surface);
    return mark_by_columns<2>(corner, n, margin, first, extent, surface);
  }
  for (int z = 0; z < extent[2]; ++z) {
    for (int y = 0; y < extent[1]; ++y) {
      for (int x = 0; x < extent[0]; ++x) surface.set(first[0] + x, first[1] + y, first[2] + z);
    }
  }
}

/// The axis across whose cell borders the triangle lies within the margin, or none. Slivers are none: they could vanish
/// between cells.
std::optional<int> axis_of_border(const std::array<Vec3, 3>& corner) {
  constexpr double least_width_cells = 8 * surface_margin_cells;
  std::optional<int> flat;
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({corner[0][a], corner[1][a], corner[2][a]});
    const double border = std::round(low);
    if (low >= border - surface_margin_cells && high <= border + surface_margin_cells) {
      if (flat) return std::nullopt;
      flat = a;
    } else if (high - low < least_width_cells) {
      return std::nullopt;
    }
  }
  return flat;
}

void mark_triangle(std::array<Vec3, 3> corner, BitGrid& surface) {
  if (const std::optional<int> axis = axis_of_border(corner)) {
    const Vec3 n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (normal_is_sure(corner, n)) {
      const double behind = std::round(corner[0][*axis]) - std::copysign(0.5, n[*axis]);
      for (Vec3& c : corner) c[*axis] = behind;
      return mark_touched(corner, -surface_margin_cells, surface);
    }
  }
  mark_touched(corner, surface_margin_cells, surface);
}

}  // namespace

void mark_surface(std::span<const Vec3> vertices_cells, std::span<const std::array<std::uint32_t, 3>> triangles,
                  BitGrid& surface) {
  parallel_for(static_cast<int>(triangles.size()), [&](int i) {
    const auto& t = triangles[i];
    mark_triangle({vertices_cells[t[0]], vertices_cells[t[1]], vertices_cells[t[2]]}, surface);
  });
}

}  // namespace ensonify
