#include "ensonify/generators/map_box.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/output/grid_files.hpp"

namespace ensonify {
namespace {

constexpr double gib = 1 << 30;

/// Upwards, to two digits.
double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit) * unit;
}

/// Cells of a box, in blocks of 8 a side as maps have them.
double cells_at_worst(const std::array<double, 3>& size) {
  double cells = 1;
  for (const double n : size) cells *= 8 * std::ceil(n / 8);
  return cells;
}

}  // namespace

WorldBox reach_of(const PlacePings& pings, MapPoses poses) {
  // Between these directions, and between neighbouring beams, the fan bulges by less than a hundredth of its range.
  constexpr std::array elevations{-0.5, -0.25, 0.0, 0.25, 0.5};
  std::vector<Vec3> directions;
  for (const double azimuth : SonarGeometry{pings.geometry}.beam_edges_rad()) {
    for (const double share : elevations) {
      directions.push_back(from_spherical({1, azimuth, share * pings.geometry.elevation_fov_rad}));
    }
  }
  WorldBox box;
  for (std::size_t i = 0; i < pings.frames.size(); ++i) {
    const Pose& pose = pings.frames[i].pose(poses);
    const Vec3 p = pose.translation();
    box = i == 0 ? WorldBox{p, p} : union_of(box, {p, p});
    for (const Vec3& direction : directions) {
      const Vec3 end = p + pings.frames[i].range_max_m * (pose.linear() * direction);
      box = union_of(box, {end, end});
    }
  }
  return box;
}

WorldBox box_of_grid(const GridFrame& frame) {
  return {frame.origin_m, frame.origin_m + frame.resolution_m * Vec3(frame.size[0], frame.size[1], frame.size[2])};
}

WorldBox union_of(const WorldBox& a, const WorldBox& b) {
  return {a.low_m.cwiseMin(b.low_m), a.high_m.cwiseMax(b.high_m)};
}

std::optional<OccupancyGrid> truth_of_place(const Dataset& dataset, const std::string& place) {
  const auto file = DatasetPaths{dataset.folder}.grid(place, ".npz");
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  return read_grid(file);
}

GridFrame frame_over(const WorldBox& box, double resolution_m, const MemoryRule& rule) {
  constexpr double rounding = 1e-6;  // of a cell: the box of a grid must give its cells again
  std::array<double, 3> first{};
  std::array<double, 3> size{};
  for (int a = 0; a < 3; ++a) {
    first[a] = std::floor(box.low_m[a] / resolution_m + rounding);
    size[a] = std::max(1.0, std::ceil(box.high_m[a] / resolution_m - rounding) - first[a]);
  }
  const double cells = cells_at_worst(size);
  const double need = cells * rule.bytes_a_cell + rule.other_bytes;
  const Vec3 extent = box.high_m - box.low_m;
  if (rule.other_bytes >= rule.limit_bytes) {
    throw ConfigError(
        fmt::format("the images of these frames take {:.3g} GiB, and {:.3g} GiB of memory are there; take "
                    "fewer with --max-frames",
                    rule.other_bytes / gib, rule.limit_bytes / gib));
  }
  constexpr double most_cells = 8589934592.0;  // 2^33, as LogOddsGrid
  if (need > rule.limit_bytes || cells >= most_cells) {
    const double may = std::min(most_cells / 2, (rule.limit_bytes - rule.other_bytes) / rule.bytes_a_cell);
    throw ConfigError(
        fmt::format("a map of {:.3g} x {:.3g} x {:.3g} m with cells of {} m has {:.3g} cells and may need {:.3g} GiB; "
                    "{:.3g} GiB of "
                    "memory are there; --resolution {:.2g} fits",
                    extent.x(), extent.y(), extent.z(), resolution_m, cells, need / gib, rule.limit_bytes / gib,
                    rounded_up(1.1 * resolution_m * std::cbrt(cells / may))));
  }
  GridFrame frame{.origin_m = {}, .resolution_m = resolution_m, .size = {}};
  for (int a = 0; a < 3; ++a) {
    frame.origin_m[a] = first[a] * resolution_m;
    frame.size[a] = static_cast<int>(size[a]);
  }
  return frame;
}

}  // namespace ensonify
