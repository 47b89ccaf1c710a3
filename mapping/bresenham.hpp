#pragma once

#include <cstdint>
#include <cstdlib>

#include "ensonify/mapping/cell_box.hpp"

namespace ensonify {

/// Whether a line visits its last cell.
enum class LineEnd : std::uint8_t { included, excluded };

namespace bresenham {

/// One axis of a line of `steps` steps: after i of them it has moved floor((2 i distance + rounding) / (2 steps))
/// cells.
struct Axis {
  std::int64_t distance;
  std::int64_t rounding;
  int sign;
};

inline std::int64_t ceil_div(std::int64_t a, std::int64_t positive) {
  return a > 0 ? (a + positive - 1) / positive : -(-a / positive);
}

}  // namespace bresenham

/// Calls visit(offset) for the cells of the 26-connected line between two cells that lie in `in`, in order from
/// `from`: Bresenham's algorithm (1965) in three dimensions, integers only. The coordinate of each cell is the nearest
/// to the line through the centres, halves towards +; so the line back has the same cells, and clipping keeps exactly
/// the cells inside. Indices must lie within +-farthest_cell.
template <typename Visit>
void walk_bresenham(const Cell& from, const Cell& to, LineEnd end, const StridedBox& in, const Visit& visit) {
  using bresenham::Axis;
  using bresenham::ceil_div;
  std::array<Axis, 3> axis{};
  std::int64_t steps = 0;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t d = std::int64_t{to[a]} - from[a];
    axis[a] = {std::abs(d), 0, d < 0 ? -1 : 1};
    steps = std::max(steps, axis[a].distance);
  }
  std::int64_t first = 0;
  std::int64_t last = end == LineEnd::included ? steps : steps - 1;
  for (Axis& x : axis) x.rounding = x.sign > 0 ? steps : steps - 1;
  if (steps == 0) {
    if (end == LineEnd::included && in.box.contains(from)) visit(in.offset(from));
    return;
  }
  if (!(in.box.contains(from) && in.box.contains(to))) {
    for (int a = 0; a < 3; ++a) {
      const auto [distance, rounding, sign] = axis[a];
      const std::int64_t least = sign > 0 ? in.box.low[a] - from[a] : from[a] - in.box.high[a] + 1;
      const std::int64_t most = sign > 0 ? in.box.high[a] - 1 - from[a] : from[a] - in.box.low[a];
      if (distance == 0) {
        if (least > 0 || most < 0) return;
        continue;
      }
      first = std::max(first, ceil_div(2 * steps * least - rounding, 2 * distance));
      last = std::min(last, ceil_div(2 * steps * (most + 1) - rounding, 2 * distance) - 1);
    }
  }
  if (first > last) return;

  // `lack`: what is missing to the next cell, in [0, 2 steps); negative once it is reached.
  Cell cell = from;
  std::array<std::int64_t, 3> lack{};
  std::array<std::ptrdiff_t, 3> stride{};
  for (int a = 0; a < 3; ++a) {
    const std::int64_t sum = 2 * first * axis[a].distance + axis[a].rounding;
    const std::int64_t moved = first == 0 ? 0 : sum / (2 * steps);
    cell[a] += static_cast<int>(axis[a].sign * moved);
    lack[a] = 2 * steps * (moved + 1) - sum - 1;
    stride[a] = axis[a].sign * in.stride[a];
  }
  std::ptrdiff_t offset = in.offset(cell);
  const auto advance = [&](int a) {
    lack[a] -= 2 * axis[a].distance;
    const std::int64_t crossed = lack[a] >> 63;
    lack[a] += 2 * steps & crossed;
    offset += stride[a] & crossed;
  };
  visit(offset);
  for (std::int64_t i = first; i < last; ++i) {
    advance(0);
    advance(1);
    advance(2);
    visit(offset);
  }
}

}  // namespace ensonify
