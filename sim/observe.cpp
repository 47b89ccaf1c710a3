#include "ensonify/sim/observe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "ensonify/core/error.hpp"
#include "ensonify/sim/voxel_surface.hpp"

namespace ensonify {
namespace {

/// The nominal field of view.
struct Frustum {
  double range_min_m, range_max_m;
  double azimuth_min_rad, azimuth_max_rad;
  double elevation_max_rad;
  Eigen::AlignedBox3d box_sonar_m;  ///< holds it

  bool holds_direction(double azimuth_rad, double elevation_rad) const {
    return azimuth_rad >= azimuth_min_rad && azimuth_rad <= azimuth_max_rad &&
           std::abs(elevation_rad) <= elevation_max_rad;
  }
};

Frustum frustum_of(const SonarGeometry& g) {
  const std::vector<double> edges = g.beam_edges_rad();
  Frustum f{g.range_min_m, g.range_max_m, edges.back(), edges.front(), 0.5 * g.elevation_fov_rad, {}};
  f.box_sonar_m.extend(Vec3::Zero());
  const auto extend = [&](double azimuth) {
    const Vec3 rim(std::cos(azimuth), std::sin(azimuth), 0);
    f.box_sonar_m.extend(g.range_max_m * (rim + std::sin(f.elevation_max_rad) * Vec3::UnitZ()));
    f.box_sonar_m.extend(g.range_max_m * (rim - std::sin(f.elevation_max_rad) * Vec3::UnitZ()));
  };
  extend(f.azimuth_min_rad);
  extend(f.azimuth_max_rad);
  for (int quarter = -2; quarter <= 2; ++quarter) {
    const double axis = quarter * 0.5 * std::numbers::pi;
    if (axis > f.azimuth_min_rad && axis < f.azimuth_max_rad) extend(axis);
  }
  return f;
}

/// The column of the ray nearest in azimuth, for descending azimuths at any spacing.
class NearestColumn {
 public:
  explicit NearestColumn(const std::vector<float>& azimuth_rad)
      : first_(azimuth_rad.front()), last_column_(static_cast<int>(azimuth_rad.size()) - 1) {
    for (std::size_t i = 0; i + 1 < azimuth_rad.size(); ++i) {
      border_.push_back(0.5 * (static_cast<double>(azimuth_rad[i]) + static_cast<double>(azimuth_rad[i + 1])));
    }
    const double width = first_ - static_cast<double>(azimuth_rad.back());
    const std::size_t slots = 4 * azimuth_rad.size();
    per_rad_ = width > 0 ? static_cast<double>(slots) / width : 0.0;
    start_.resize(slots);
    int column = 0;
    for (std::size_t s = 0; s < slots; ++s) {
      while (column < last_column_ && first_ - border_[column] < static_cast<double>(s) / per_rad_) ++column;
      start_[s] = std::max(column - 1, 0);  // one early: rounding of the slot must not step over a column
    }
  }

  int operator()(double azimuth_rad) const {
    const double slot = std::clamp((first_ - azimuth_rad) * per_rad_, 0.0, static_cast<double>(start_.size() - 1));
    int column = start_[static_cast<std::size_t>(slot)];
    while (column < last_column_ && azimuth_rad < border_[column]) ++column;
    return column;
  }

 private:
  double first_;
  int last_column_;
  double per_rad_ = 0;
  std::vector<double> border_;
  std::vector<int> start_;
};

/// Part [begin, end) of a row of cells whose centres start + step * i lie in the box.
std::pair<int, int> clip_row(const Vec3& start, const Vec3& step, const Eigen::AlignedBox3d& box, int cells) {
  double low = 0;
  double high = cells - 1;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(step[a]) < 1e-12) {
      if (start[a] < box.min()[a] || start[a] > box.max()[a]) return {0, 0};
      continue;
    }
    const auto [near, far] = std::minmax({(box.min()[a] - start[a]) / step[a], (box.max()[a] - start[a]) / step[a]});
    low = std::max(low, near);
    high = std::min(high, far);
  }
  if (!(low <= high)) return {0, 0};
  return {static_cast<int>(std::floor(low)), std::min(static_cast<int>(std::ceil(high)) + 1, cells)};
}

/// Ascending cells, joined into runs.
class Runs {
 public:
  void add(std::size_t cell) {
    const auto c = static_cast<std::uint32_t>(cell);
    if (!runs_.empty() && runs_.back().first + runs_.back().count == c) {
      ++runs_.back().count;
    } else {
      runs_.push_back({c, 1});
    }
  }
  std::vector<CellRun> take() { return std::move(runs_); }

 private:
  std::vector<CellRun> runs_;
};

std::vector<CellRun> free_cells(const PingTruth& truth, const Frustum& frustum, const Pose& T_world_sonar,
                                const OccupancyGrid& grid) {
  const GridFrame& frame = grid.frame;
  Eigen::AlignedBox3d world;
  for (int i = 0; i < 8; ++i) {
    world.extend(T_world_sonar * frustum.box_sonar_m.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  const Vec3 low = ((world.min() - frame.origin_m) / frame.resolution_m).array().floor();
  const Vec3 high = ((world.max() - frame.origin_m) / frame.resolution_m).array().ceil();
  const auto clamp_cell = [&](double i, int axis) {
    return static_cast<int>(std::clamp(i, 0.0, static_cast<double>(frame.size[axis])));
  };
  const int y_begin = clamp_cell(low.y(), 1);
  const int y_end = clamp_cell(high.y(), 1);
  const int z_begin = clamp_cell(low.z(), 2);
  const int z_end = clamp_cell(high.z(), 2);

  const Pose T_sonar_world = T_world_sonar.inverse();
  const Vec3 step = T_sonar_world.linear().col(0) * frame.resolution_m;
  const double rows_per_rad = 1.0 / truth.elevation_step_rad;
  const double last_row = truth.first_hit_range_m.rows() - 1;
  const NearestColumn column_of(truth.ray_azimuth_rad);
  const double range2_min = frustum.range_min_m * frustum.range_min_m;
  const double range2_max = frustum.range_max_m * frustum.range_max_m;
  const double sin2_elevation = std::pow(std::sin(std::min(frustum.elevation_max_rad, 0.5 * std::numbers::pi)), 2);

  Runs runs;
  for (int z = z_begin; z < z_end; ++z) {
    for (int y = y_begin; y < y_end; ++y) {
      const Vec3 start = T_sonar_world * frame.centre_m(0, y, z);
      const auto [begin, end] = clip_row(start, step, frustum.box_sonar_m, frame.size[0]);
      const std::size_t row = frame.index(0, y, z);
      for (int x = begin; x < end; ++x) {
        if (grid.occupancy[row + static_cast<std::size_t>(x)] != static_cast<std::uint8_t>(Occupancy::free)) continue;
        const Vec3 p = start + x * step;
        const double range2 = p.squaredNorm();
        if (range2 < range2_min || range2 > range2_max) continue;
        if (p.z() * p.z() > sin2_elevation * range2 * (1 + 1e-9)) continue;  // cheap, before the arc tangents
        const double azimuth = std::atan2(p.y(), p.x());
        const double elevation = std::atan2(p.z(), std::sqrt(p.x() * p.x() + p.y() * p.y()));
        if (!frustum.holds_direction(azimuth, elevation)) continue;
        const int column = column_of(azimuth);
        const double nearest_row = std::round((elevation - truth.lowest_elevation_rad[column]) * rows_per_rad);
        const double hit = truth.first_hit_range_m(static_cast<int>(std::clamp(nearest_row, 0.0, last_row)), column);
        if (range2 < hit * hit) runs.add(row + static_cast<std::size_t>(x));
      }
    }
  }
  return runs.take();
}

std::vector<CellRun> hit_cells(const PingTruth& truth, const Frustum& frustum, const Pose& T_world_sonar,
                               const OccupancyGrid& grid) {
  std::vector<std::uint32_t> cells;
  // In cells of the grid; a ray is a sum of its column's and its row's vectors.
  const Eigen::Matrix3d axes = T_world_sonar.linear() / grid.frame.resolution_m;
  const Vec3 sonar = (T_world_sonar.translation() - grid.frame.origin_m) / grid.frame.resolution_m;
  const Vec3 beyond(grid.frame.size[0], grid.frame.size[1], grid.frame.size[2]);
  struct Column {
    int index;
    Vec3 ahead;
  };
  std::vector<Column> columns;
  for (int c = 0; c < truth.first_hit_range_m.columns(); ++c) {
    const double azimuth = truth.ray_azimuth_rad[c];
    if (!frustum.holds_direction(azimuth, 0)) continue;
    columns.push_back({c, axes * Vec3(std::cos(azimuth), std::sin(azimuth), 0)});
  }
  const auto surface_cell = [&](const Vec3& at) -> std::optional<std::uint32_t> {
    if (!((at.array() >= 0).all() && (at.array() < beyond.array()).all())) return std::nullopt;
    const std::size_t cell =
        grid.frame.index(static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z()));
    if (grid.occupancy[cell] != static_cast<std::uint8_t>(Occupancy::surface)) return std::nullopt;
    return static_cast<std::uint32_t>(cell);
  };
  // A hit on a border of cells belongs to the layer behind it, where the face was marked, however its range was
  // rounded.
  const double rounding_m = 0.9 * surface_margin_cells * grid.frame.resolution_m;
  for (int r = 0; r < truth.first_hit_range_m.rows(); ++r) {
    for (const Column& column : columns) {
      const double range = truth.first_hit_range_m(r, column.index);
      if (!(range >= frustum.range_min_m && range <= frustum.range_max_m)) continue;
      const double elevation =
          truth.lowest_elevation_rad[column.index] + static_cast<double>(r) * truth.elevation_step_rad;
      if (std::abs(elevation) > frustum.elevation_max_rad) continue;
      const Vec3 ahead = std::cos(elevation) * column.ahead + std::sin(elevation) * axes.col(2);
      const std::optional<std::uint32_t> behind = surface_cell(sonar + (range + rounding_m) * ahead);
      const std::optional<std::uint32_t> cell = behind ? behind : surface_cell(sonar + (range - rounding_m) * ahead);
      if (cell && (cells.empty() || cells.back() != *cell)) cells.push_back(*cell);  // mostly that of the ray before
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  Runs runs;
  for (const std::uint32_t cell : cells) runs.add(cell);
  return runs.take();
}

}  // namespace

std::vector<CellRun> observed_cells(const PingTruth& truth, const SonarGeometry& geometry, const Pose& T_world_sonar,
                                    const OccupancyGrid& grid) {
  const auto& hits = truth.first_hit_range_m;
  const auto columns = static_cast<std::size_t>(hits.columns());
  if (hits.empty() || columns != truth.ray_azimuth_rad.size() || columns != truth.lowest_elevation_rad.size() ||
      !(truth.elevation_step_rad > 0.0f)) {
    throw ConfigError("ping truth: needs an azimuth and a lowest elevation for each column of first hits, and a step");
  }
  if (geometry.beams() == 0) throw ConfigError("sonar geometry: no beams; give at least one azimuth");
  if (!T_world_sonar.matrix().allFinite()) {
    throw ConfigError("sonar pose: not a number in it; check where the pose comes from");
  }
  if (grid.occupancy.size() != grid.frame.cells() || grid.frame.cells() > std::numeric_limits<std::uint32_t>::max()) {
    throw ConfigError("occupancy grid: its number of cells does not match its frame; voxelise the scene first");
  }
  const Frustum frustum = frustum_of(geometry);
  const std::vector<CellRun> free = free_cells(truth, frustum, T_world_sonar, grid);
  const std::vector<CellRun> hit = hit_cells(truth, frustum, T_world_sonar, grid);
  std::vector<CellRun> all(free.size() + hit.size());
  std::merge(free.begin(), free.end(), hit.begin(), hit.end(), all.begin(),
             [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
  return all;
}

void mark_observed(const PingTruth& truth, const SonarGeometry& geometry, const Pose& T_world_sonar,
                   OccupancyGrid& grid) {
  const std::vector<CellRun> runs = observed_cells(truth, geometry, T_world_sonar, grid);
  if (grid.observable.empty()) grid.observable.assign(grid.frame.cells(), 0);
  for (const CellRun& run : runs) std::fill_n(grid.observable.begin() + run.first, run.count, std::uint8_t{1});
}

}  // namespace ensonify
