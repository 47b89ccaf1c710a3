#include "ensonify/generators/explore_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr float closer_worth = 0.5F;     ///< of an occupied column's closer look; an unknown one has 1
constexpr double deepest_m = 8;          ///< of unknown columns before one: worth nothing
constexpr double charged_depth_m = 0.3;  ///< what lies deeper in the unknown may well be hidden

/// Calls visit(column, range, metres of unknown columns before) for points one column's width apart, until visit
/// returns false or after an occupied column.
template <typename Visit>
void march(const Slice& slice, const SonarView& view, double x_m, double y_m, double bearing, const Visit& visit) {
  const double step_m = slice.frame.resolution_m;
  const double dx = step_m * std::cos(bearing);
  const double dy = step_m * std::sin(bearing);
  double unknown_m = 0;
  const int steps = static_cast<int>(view.range_max_m / step_m);
  for (int i = 1; i <= steps; ++i) {
    const int ix = slice.ix_of(x_m + i * dx);
    const int iy = slice.iy_of(y_m + i * dy);
    if (!slice.contains(ix, iy)) return;
    const std::size_t column = slice.index(ix, iy);
    const ColumnState state = slice.columns[column];
    const double range_m = i * step_m;
    if (range_m >= view.nearest_m && !visit(column, range_m, unknown_m)) return;
    if (state == ColumnState::occupied) return;
    // Those too near to be told of hide nothing: the fan passes through them.
    if (state == ColumnState::unknown && range_m >= view.nearest_m) unknown_m += step_m;
  }
}

bool counts(const Slice& slice, const ColumnWorth& worth, std::size_t column, double range_m) {
  if (worth.look[column] <= 0) return false;
  return slice.columns[column] != ColumnState::occupied || range_m <= worth.closer_m[column];
}

void add_one(const ColumnMask& mask, std::vector<std::uint8_t>& counts) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 && counts[i] < 255) ++counts[i];
  }
}

}  // namespace

SonarView view_of(const SonarGeometry& geometry, double elevation_fov_rad, const GridFrame& slab, double z_m) {
  const std::vector<double> edges = geometry.beam_edges_rad();
  double off_m = 0;
  for (int iz = 0; iz < slab.size[2]; ++iz) off_m = std::max(off_m, std::abs(slab.centre_m(0, 0, iz).z() - z_m));
  const double nearest = slab.size[2] == 1 ? 0.0 : off_m / std::tan(0.5 * elevation_fov_rad);
  return {edges.front(), edges.back(), std::max(geometry.range_min_m, nearest), geometry.range_max_m};
}

ColumnWorth worth_of(const Slice& slice, const ColumnMask& interest, const LookMemory& looks, double resolved_m) {
  ColumnWorth worth{std::vector<float>(slice.columns.size()), std::vector<float>(slice.columns.size())};
  const auto resolved = static_cast<float>(resolved_m);
  for (std::size_t i = 0; i < slice.columns.size(); ++i) {
    if (interest[i] == 0) continue;
    const float left = std::exp2(-static_cast<float>(looks.in_vain[i]));
    if (slice.columns[i] == ColumnState::unknown) worth.look[i] = left;
    if (slice.columns[i] == ColumnState::occupied && looks.nearest_m[i] > resolved) {
      worth.look[i] = closer_worth * left;
      worth.closer_m[i] = std::max(resolved, 0.5F * looks.nearest_m[i]);
    }
  }
  return worth;
}

std::vector<double> worth_by_bearing(const Slice& slice, const ColumnWorth& worth, const SonarView& view, double x_m,
                                     double y_m, int bearings) {
  std::vector<double> sums(static_cast<std::size_t>(bearings));
  const double between = turn / bearings;
  for (int i = 0; i < bearings; ++i) {
    double sum = 0;
    march(slice, view, x_m, y_m, between * (i + 0.5), [&](std::size_t column, double range_m, double unknown_m) {
      if (counts(slice, worth, column, range_m)) sum += worth.look[column] * range_m * std::exp2(-unknown_m);
      return unknown_m < deepest_m;
    });
    sums[static_cast<std::size_t>(i)] = sum * between * slice.frame.resolution_m;
  }
  return sums;
}

std::vector<double> worth_by_heading(const std::vector<double>& by_bearing, const SonarView& view) {
  const int n = static_cast<int>(by_bearing.size());
  const double between = turn / n;
  const int first = static_cast<int>(std::ceil(view.starboard_rad / between));
  const int last = static_cast<int>(std::floor(view.port_rad / between));
  std::vector<double> sums(by_bearing.size());
  for (int heading = 0; heading < n; ++heading) {
    for (int i = first; i <= last; ++i) {
      sums[static_cast<std::size_t>(heading)] += by_bearing[static_cast<std::size_t>(((heading + i) % n + n) % n)];
    }
  }
  return sums;
}

void count_looks(const Slice& slice, const SonarView& view, const PlanarPose& at, LookMemory& looks) {
  ColumnMask in_vain(slice.columns.size());
  const int rays = 1 + static_cast<int>((view.port_rad - view.starboard_rad) / radians(0.25));
  for (int i = 0; i < rays; ++i) {
    const double azimuth = view.starboard_rad + (i + 0.5) * (view.port_rad - view.starboard_rad) / rays;
    march(slice, view, at.x_m, at.y_m, at.yaw_rad + azimuth, [&](std::size_t column, double range_m, double unknown_m) {
      if (unknown_m >= charged_depth_m) return false;
      if (slice.columns[column] == ColumnState::unknown) in_vain[column] = 1;
      if (slice.columns[column] == ColumnState::occupied) {
        looks.nearest_m[column] = std::min(looks.nearest_m[column], static_cast<float>(range_m));
      }
      return true;
    });
  }
  add_one(in_vain, looks.in_vain);
}

void count_in_vain(const Slice& slice, const ColumnWorth& worth, const SonarView& view, const PlanarPose& at,
                   int bearings, LookMemory& looks) {
  ColumnMask seen(slice.columns.size());
  for (int i = 0; i < bearings; ++i) {
    const double bearing = turn / bearings * (i + 0.5);
    const double azimuth = bearing - at.yaw_rad - turn * std::round((bearing - at.yaw_rad) / turn);
    if (azimuth < view.starboard_rad || azimuth > view.port_rad) continue;
    march(slice, view, at.x_m, at.y_m, bearing, [&](std::size_t column, double range_m, double unknown_m) {
      if (counts(slice, worth, column, range_m)) seen[column] = 1;
      return unknown_m < deepest_m;
    });
  }
  add_one(seen, looks.in_vain);
}

}  // namespace ensonify
