#include "ensonify/mapping/insert_scan.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/mapping/exact_line.hpp"

namespace ensonify {
namespace {

constexpr int lines_a_task = 512;

/// A point in cells from the grid's corner, and whether its cell may be named.
Vec3 in_cells(const GridFrame& frame, const Vec3& p) { return (p - frame.origin_m) / frame.resolution_m; }
bool can_be_named(const Vec3& p_cells) { return (p_cells.array().abs() < farthest_cell).all(); }  // false for NaN
Cell cell_of(const Vec3& p_cells) {
  return {static_cast<int>(std::floor(p_cells.x())), static_cast<int>(std::floor(p_cells.y())),
          static_cast<int>(std::floor(p_cells.z()))};
}

/// Where a ray ends, in cells, and whether at a surface.
struct RayEnd {
  Vec3 p_cells;
  bool is_hit;
};

RayEnd end_of(const Vec3& origin, const Vec3& point, double max_range_cells) {
  const Vec3 ray = point - origin;
  const double square = ray.squaredNorm();
  if (!(square > max_range_cells * max_range_cells)) return {point, true};
  return {origin + ray * (max_range_cells / std::sqrt(square)), false};
}

/// Several threads may set the same mark.
struct Freer {
  Mark* marks;
  void operator()(std::ptrdiff_t offset) const {
    std::atomic_ref<Mark>(marks[offset]).store(Mark::free, std::memory_order_relaxed);
  }
};

template <typename Line>
void parallel_lines(std::size_t count, const Line& line) {
  parallel_for(static_cast<int>((count + lines_a_task - 1) / lines_a_task), [&](int task) {
    const std::size_t first = static_cast<std::size_t>(task) * lines_a_task;
    for (std::size_t i = first; i < std::min(count, first + lines_a_task); ++i) line(i);
  });
}

/// Fills the ends of the rays that can be used, and gives the box from their first to their last cells.
CellBox find_ends(const RangeScan& scan, const Vec3& origin, const GridFrame& frame, double max_range_cells,
                  ScanScratch& scratch) {
  CellBox reach = {cell_of(origin), cell_of(origin)};
  scratch.end_cell.clear();
  scratch.is_hit.clear();
  for (const Vec3& point : scan.points_m) {
    const Vec3 p = in_cells(frame, point);
    if (!p.allFinite()) continue;
    const RayEnd end = end_of(origin, p, max_range_cells);
    if (!can_be_named(end.p_cells)) continue;
    const Cell cell = cell_of(end.p_cells);
    for (std::size_t a = 0; a < 3; ++a) {
      reach.low[a] = std::min(reach.low[a], cell[a]);
      reach.high[a] = std::max(reach.high[a], cell[a]);
    }
    scratch.end_cell.push_back(cell);
    scratch.is_hit.push_back(end.is_hit);
  }
  for (int& high : reach.high) ++high;
  return reach;
}

/// One line for all rays with the same end cell. Ends outside the grid are not compared.
void free_lines_between_cells(const Cell& origin, ScanScratch& scratch) {
  constexpr Mark seen{3};
  const StridedBox& layout = scratch.marks.layout();
  Mark* marks = scratch.marks.data();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scratch.end_cell.size(); ++i) {
    const Cell end = scratch.end_cell[i];
    const bool hit = scratch.is_hit[i] != 0;
    if (layout.box.contains(end)) {
      Mark& mark = marks[layout.offset(end)];
      const bool repeated = mark != Mark::none;
      if (hit || !repeated) mark = hit ? Mark::occupied : seen;
      if (repeated) continue;
    }
    scratch.end_cell[kept++] = end;
  }
  // Lines overwrite the marks of ends: note the hits first.
  scratch.is_hit.resize(kept);
  scratch.end_cell.resize(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    const Cell& end = scratch.end_cell[i];
    if (!layout.box.contains(end)) continue;
    Mark& mark = marks[layout.offset(end)];
    scratch.is_hit[i] = mark == Mark::occupied;
    mark = Mark::none;
  }
  parallel_lines(kept, [&](std::size_t i) {
    walk_bresenham(origin, scratch.end_cell[i], LineEnd::excluded, layout, Freer{marks});
  });
}

}  // namespace

std::size_t insert_scan(const RangeScan& scan, const ScanOptions& options, LogOddsGrid& grid, ScanScratch& scratch) {
  const GridFrame& frame = grid.frame();
  const Vec3 origin = in_cells(frame, scan.origin_m);
  if (!can_be_named(origin)) {
    throw DataError(
        fmt::format("scan from ({}, {}, {}) m: the place must be finite and within 2^29 cells of the map's "
                    "corner; leave the scan out or repair its pose",
                    scan.origin_m.x(), scan.origin_m.y(), scan.origin_m.z()));
  }
  if (!(options.max_range_m > 0)) {
    throw ConfigError(fmt::format("max_range_m is {}; it must be above 0", options.max_range_m));
  }
  require_valid(options.step);
  const double max_range_cells = options.max_range_m / frame.resolution_m;

  const CellBox inside = intersection(find_ends(scan, origin, frame, max_range_cells, scratch), box_of(frame));
  const std::size_t used = scratch.end_cell.size();
  if (used == 0 || inside.empty()) return used;

  scratch.marks.reset(inside);
  Mark* marks = scratch.marks.data();
  if (options.rule == LineRule::bresenham_once_an_end) {
    free_lines_between_cells(cell_of(origin), scratch);
  } else {
    parallel_lines(scan.points_m.size(), [&](std::size_t i) {
      const Vec3 p = in_cells(frame, scan.points_m[i]);
      if (!p.allFinite()) return;
      const RayEnd end = end_of(origin, p, max_range_cells);
      if (can_be_named(end.p_cells)) {
        walk_exact(origin, end.p_cells, LineEnd::excluded, scratch.marks.layout(), Freer{marks});
      }
    });
  }
  for (std::size_t i = 0; i < scratch.end_cell.size(); ++i) {
    if (scratch.is_hit[i] && inside.contains(scratch.end_cell[i])) {
      marks[scratch.marks.layout().offset(scratch.end_cell[i])] = Mark::occupied;
    }
  }
  grid.apply(scratch.marks, options.step);
  return used;
}

std::size_t insert_scan(const RangeScan& scan, const ScanOptions& options, LogOddsGrid& grid) {
  ScanScratch scratch;
  return insert_scan(scan, options, grid, scratch);
}

}  // namespace ensonify
