#include "ensonify/generators/explore_ways.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>

namespace ensonify {

double turn_between(double from_rad, double to_rad) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double angle = to_rad - from_rad + std::numbers::pi;
  return angle - turn * std::floor(angle / turn) - std::numbers::pi;
}

PlanarPose limited_step(const PlanarPose& from, const PlanarPose& wanted, const MotionLimits& limits) {
  const double dx = wanted.x_m - from.x_m;
  const double dy = wanted.y_m - from.y_m;
  const double distance = std::hypot(dx, dy);
  const double share = distance > limits.step_m() ? limits.step_m() / distance : 1.0;
  const double turn = std::clamp(turn_between(from.yaw_rad, wanted.yaw_rad), -limits.step_rad(), limits.step_rad());
  return {from.x_m + share * dx, from.y_m + share * dy, turn_between(0.0, from.yaw_rad + turn)};
}

Ways shortest_ways(const Slice& slice, const ColumnMask& allowed, int ix, int iy) {
  Ways ways{std::vector<double>(slice.columns.size(), std::numeric_limits<double>::infinity()),
            std::vector<std::int32_t>(slice.columns.size(), -1)};
  using Entry = std::pair<double, std::size_t>;  // ties by column: one order on every machine
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  if (!slice.contains(ix, iy)) return ways;
  ways.length_m[slice.index(ix, iy)] = 0.0;
  open.emplace(0.0, slice.index(ix, iy));
  const auto width = static_cast<std::size_t>(slice.frame.size[0]);
  const auto may = [&](int x, int y) { return slice.contains(x, y) && allowed[slice.index(x, y)] != 0; };
  while (!open.empty()) {
    const auto [length, column] = open.top();
    open.pop();
    if (length > ways.length_m[column]) continue;
    const int x = static_cast<int>(column % width);
    const int y = static_cast<int>(column / width);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || !may(x + dx, y + dy)) continue;
        const bool diagonal = dx != 0 && dy != 0;
        if (diagonal && !(may(x + dx, y) && may(x, y + dy))) continue;
        const double there = length + slice.frame.resolution_m * (diagonal ? std::numbers::sqrt2 : 1.0);
        const std::size_t next = slice.index(x + dx, y + dy);
        if (there >= ways.length_m[next]) continue;
        ways.length_m[next] = there;
        ways.before[next] = static_cast<std::int32_t>(column);
        open.emplace(there, next);
      }
    }
  }
  return ways;
}

bool line_allowed(const Slice& slice, const ColumnMask& allowed, double x0_m, double y0_m, double x1_m, double y1_m) {
  const double length = std::hypot(x1_m - x0_m, y1_m - y0_m);
  const int pieces = static_cast<int>(std::ceil(length / (0.25 * slice.frame.resolution_m)));
  for (int i = 0; i <= pieces; ++i) {
    const double share = pieces == 0 ? 0.0 : static_cast<double>(i) / pieces;
    const int ix = slice.ix_of(x0_m + share * (x1_m - x0_m));
    const int iy = slice.iy_of(y0_m + share * (y1_m - y0_m));
    if (!slice.contains(ix, iy) || allowed[slice.index(ix, iy)] == 0) return false;
  }
  return true;
}

std::vector<std::size_t> way_to(const Ways& ways, std::size_t column) {
  std::vector<std::size_t> way;
  if (!ways.reaches(column)) return way;
  for (auto at = static_cast<std::int32_t>(column); at >= 0; at = ways.before[static_cast<std::size_t>(at)]) {
    way.push_back(static_cast<std::size_t>(at));
  }
  std::ranges::reverse(way);
  return way;
}

PlanarPose carrot(const Slice& slice, const ColumnMask& allowed, const std::vector<std::size_t>& way,
                  const PlanarPose& from, double look_ahead_m) {
  const auto width = static_cast<std::size_t>(slice.frame.size[0]);
  const auto most = static_cast<std::size_t>(std::max(1.0, look_ahead_m / slice.frame.resolution_m));
  PlanarPose best = from;
  for (std::size_t i = 0; i < std::min(way.size(), most + 1); ++i) {
    const double x = slice.x_m(static_cast<int>(way[i] % width));
    const double y = slice.y_m(static_cast<int>(way[i] / width));
    // The first two columns must be open to it wherever it stands within its own: else rounding could hold it there.
    if (i < 2 || line_allowed(slice, allowed, from.x_m, from.y_m, x, y)) best = {x, y, from.yaw_rad};
  }
  return best;
}

}  // namespace ensonify
