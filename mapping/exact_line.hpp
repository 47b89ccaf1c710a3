#pragma once

#include <cmath>
#include <cstdint>

#include "ensonify/mapping/bresenham.hpp"

namespace ensonify {

namespace exact_line {

/// The length of a line in units of its time.
constexpr std::int64_t whole = std::int64_t{1} << 61;

/// When a line crosses the borders of cells along one axis: the k-th (from 0) at first + k * between.
struct Axis {
  std::int64_t first = 2 * whole;
  std::int64_t between = 0;
  std::int64_t crossings = 0;
  int sign = 1;

  /// Crossings at or before `time`.
  std::int64_t until(std::int64_t time) const {
    if (crossings == 0 || time < first) return 0;
    return std::min(crossings, (time - first) / between + 1);
  }
};

inline std::int64_t time_of(double share) {
  return static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(whole));
}

inline Axis axis_of(double from, double to, int from_cell, int to_cell) {
  Axis x;
  x.sign = to_cell < from_cell ? -1 : 1;
  x.crossings = std::abs(std::int64_t{to_cell} - from_cell);
  if (x.crossings == 0) return x;
  const double border = x.sign > 0 ? from_cell + 1.0 : from_cell;
  x.between = std::max<std::int64_t>(1, time_of(1 / std::abs(to - from)));
  // Rounding must neither lose a crossing that happens nor add one that does not: then any line ends in its last cell.
  x.first = std::min(time_of((border - from) / (to - from)), whole - (x.crossings - 1) * x.between);
  x.first = std::max(x.first, whole + 1 - x.crossings * x.between);
  return x;
}

}  // namespace exact_line

/// Calls visit(offset) for every cell of `in` that the line between two points passes through, in order: Amanatides and
/// Woo (1987). Points in cells: point / resolution, with floor(p) the index of its cell. Where the line leaves through
/// an edge, cells on the side of the higher axis (z before y before x) are taken, one axis at a time. Times are
/// integers of 2^-61 of the line, so that errors do not grow along it, and the last cell is always that of `to`. The
/// line back has the same cells but where it meets an edge within rounding. Coordinates must be finite and within
/// +-farthest_cell.
template <typename Visit>
void walk_exact(const Vec3& from, const Vec3& to, LineEnd end, const StridedBox& in, const Visit& visit) {
  using exact_line::Axis;
  Cell cell{};
  Cell last{};
  std::array<Axis, 3> axis{};
  for (int a = 0; a < 3; ++a) {
    cell[a] = static_cast<int>(std::floor(from[a]));
    last[a] = static_cast<int>(std::floor(to[a]));
    axis[a] = exact_line::axis_of(from[a], to[a], cell[a], last[a]);
  }
  std::int64_t cells = axis[0].crossings + axis[1].crossings + axis[2].crossings + (end == LineEnd::included ? 1 : 0);

  if (!(in.box.contains(cell) && in.box.contains(last))) {
    std::int64_t enter = -1;
    std::int64_t leave = 2 * exact_line::whole;
    for (int a = 0; a < 3; ++a) {
      const Axis& x = axis[a];
      const std::int64_t before = x.sign > 0 ? in.box.low[a] - cell[a] : cell[a] - in.box.high[a] + 1;
      const std::int64_t beyond = x.sign > 0 ? in.box.high[a] - cell[a] : cell[a] - in.box.low[a] + 1;
      if (before > x.crossings || beyond <= 0) return;
      if (before > 0) enter = std::max(enter, x.first + (before - 1) * x.between);
      if (beyond <= x.crossings) leave = std::min(leave, x.first + (beyond - 1) * x.between);
    }
    if (enter >= leave) return;
    const bool leaves = leave < 2 * exact_line::whole;
    std::int64_t steps = 0;
    for (int a = 0; a < 3; ++a) {
      Axis& x = axis[a];
      const std::int64_t made = x.until(enter);
      steps += (leaves ? x.until(leave - 1) : x.crossings) - made;
      cell[a] += static_cast<int>(x.sign * made);
      x.first += made * x.between;
    }
    cells = leaves ? steps + 1 : steps + (end == LineEnd::included ? 1 : 0);
  }

  std::ptrdiff_t offset = in.offset(cell);
  std::int64_t tx = axis[0].first;
  std::int64_t ty = axis[1].first;
  std::int64_t tz = axis[2].first;
  const std::ptrdiff_t sx = axis[0].sign * in.stride[0];
  const std::ptrdiff_t sy = axis[1].sign * in.stride[1];
  const std::ptrdiff_t sz = axis[2].sign * in.stride[2];
  for (; cells > 0; --cells) {
    visit(offset);
    // Masks, because which axis is next can not be predicted.
    const std::int64_t x_before_y = -std::int64_t{tx < ty};
    const std::int64_t not_z = -std::int64_t{std::min(tx, ty) < tz};
    const std::int64_t x = not_z & x_before_y;
    const std::int64_t y = not_z & ~x_before_y;
    tx += axis[0].between & x;
    ty += axis[1].between & y;
    tz += axis[2].between & ~not_z;
    offset += (sx & x) | (sy & y) | (sz & ~not_z);
  }
}

}  // namespace ensonify
