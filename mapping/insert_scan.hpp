#pragma once

#include <limits>
#include <vector>

#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

/// What a range finder saw from one place: points on surfaces, world frame. A miss is any point beyond the maximum
/// range, in the direction of the ray.
struct RangeScan {
  Vec3 origin_m = Vec3::Zero();
  std::vector<Vec3> points_m;
};

/// Which cells a ray frees.
enum class LineRule : std::uint8_t {
  /// Rays that end in one cell are one line between the centres of the end cells, by Bresenham.
  bresenham_once_an_end,
  /// Every ray, every cell that it passes through, as OctoMap's insertPointCloud (Hornung et al. 2013).
  exact_every_ray,
};

struct ScanOptions {
  LineRule rule = LineRule::exact_every_ray;
  double max_range_m = std::numeric_limits<double>::infinity();
  LogOddsStep step = {};
};

/// Scratch memory of scans, to be used again.
struct ScanScratch {
  MarkBox<Mark> marks;
  std::vector<Cell> end_cell;
  std::vector<std::uint8_t> is_hit;
};

/// Adds a scan to the map: cells with a point are occupied, cells before on the ray free, each cell once a scan,
/// occupied wins. A point beyond max_range_m frees its ray as far as that, without the cell there, and occupies
/// nothing. A ray with a point that is no number, or 2^29 cells and more from the grid's corner, is left out; the count
/// of those used is returned. What lies outside the grid is dropped. Throws DataError for an origin that is no number
/// or as far away, ConfigError for options out of range. The result does not depend on the number of threads.
std::size_t insert_scan(const RangeScan& scan, const ScanOptions& options, LogOddsGrid& grid, ScanScratch& scratch);
std::size_t insert_scan(const RangeScan& scan, const ScanOptions& options, LogOddsGrid& grid);

}  // namespace ensonify
