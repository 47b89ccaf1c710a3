#include "ensonify/generators/explore_scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ensonify {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? nan : static_cast<double>(part) / static_cast<double>(whole);
}

/// The free slice eroded by the radius, as far as it hangs together with the start.
ColumnMask places_of_axis(const Slice& truth, const ColumnMask& area, const PlanarPose& start, double radius_m) {
  ColumnMask allowed = columns_with_room(truth, radius_m);
  for (std::size_t i = 0; i < allowed.size(); ++i) allowed[i] = allowed[i] != 0 && area[i] != 0 ? 1 : 0;
  const int ix = truth.ix_of(start.x_m);
  const int iy = truth.iy_of(start.y_m);
  ColumnMask places(truth.columns.size());
  if (!truth.contains(ix, iy) || allowed[truth.index(ix, iy)] == 0) return places;
  const Ways ways = shortest_ways(truth, allowed, ix, iy);
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = ways.reaches(i) ? 1 : 0;
  return places;
}

/// Rays in all directions from every fifth place, half a column apart at the sonar's range.
ColumnMask occupied_in_sight(const Slice& truth, const ColumnMask& places, double range_m) {
  ColumnMask seen(truth.columns.size());
  const double step_m = 0.5 * truth.frame.resolution_m;
  const int rays = static_cast<int>(std::ceil(4.0 * std::numbers::pi * range_m / truth.frame.resolution_m));
  constexpr int lattice = 5;
  for (int iy = 0; iy < truth.frame.size[1]; iy += lattice) {
    for (int ix = 0; ix < truth.frame.size[0]; ix += lattice) {
      if (places[truth.index(ix, iy)] == 0) continue;
      for (int ray = 0; ray < rays; ++ray) {
        const double bearing = 2.0 * std::numbers::pi * ray / rays;
        const double dx = step_m * std::cos(bearing);
        const double dy = step_m * std::sin(bearing);
        for (int i = 0; i * step_m <= range_m; ++i) {
          const int x = truth.ix_of(truth.x_m(ix) + i * dx);
          const int y = truth.iy_of(truth.y_m(iy) + i * dy);
          if (!truth.contains(x, y)) break;
          if (truth.columns[truth.index(x, y)] != ColumnState::occupied) continue;
          seen[truth.index(x, y)] = 1;
          break;
        }
      }
    }
  }
  return seen;
}

}  // namespace

ReachableSlice reachable_slice(const Slice& truth, const ColumnMask& axis_area, const PlanarPose& start,
                               double radius_m, double sonar_range_m) {
  const ColumnMask places = places_of_axis(truth, axis_area, start, radius_m);
  ReachableSlice reachable{ColumnMask(truth.columns.size()), occupied_in_sight(truth, places, sonar_range_m)};
  constexpr double rounding_m = 1e-9;  // three columns of 0.1 m are 0.30000000000000004 m
  const int reach = static_cast<int>(std::ceil(radius_m / truth.frame.resolution_m));
  for (int iy = 0; iy < truth.frame.size[1]; ++iy) {
    for (int ix = 0; ix < truth.frame.size[0]; ++ix) {
      if (places[truth.index(ix, iy)] == 0) continue;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const bool within = std::hypot(dx, dy) * truth.frame.resolution_m <= radius_m + rounding_m;
          if (within && truth.contains(ix + dx, iy + dy)) reachable.free[truth.index(ix + dx, iy + dy)] = 1;
        }
      }
    }
  }
  return reachable;
}

ExploreScores score_slice(const Slice& map, const ReachableSlice& reachable) {
  std::size_t free = 0, free_as_free = 0, free_as_occupied = 0;
  std::size_t boundary = 0, boundary_as_free = 0, boundary_as_occupied = 0;
  for (std::size_t i = 0; i < map.columns.size(); ++i) {
    const bool says_free = map.columns[i] == ColumnState::free;
    const bool says_occupied = map.columns[i] == ColumnState::occupied;
    if (reachable.free[i] != 0) ++free, free_as_free += says_free, free_as_occupied += says_occupied;
    if (reachable.boundary[i] != 0) {
      ++boundary, boundary_as_free += says_free, boundary_as_occupied += says_occupied;
    }
  }
  return {share(free_as_free, free), share(boundary_as_occupied, boundary),
          share(boundary_as_free, boundary_as_free + boundary_as_occupied),
          share(free_as_occupied, free_as_free + free_as_occupied)};
}

double clearance_m(const Slice& truth, const PlanarPose& from, const PlanarPose& to, double far_m) {
  const double length = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  const int pieces = static_cast<int>(std::ceil(length / 0.02));
  const int reach = 1 + static_cast<int>(far_m / truth.frame.resolution_m);
  double least = far_m;
  for (int i = 0; i <= pieces; ++i) {
    const double along = pieces == 0 ? 0.0 : static_cast<double>(i) / pieces;
    const double x = from.x_m + along * (to.x_m - from.x_m);
    const double y = from.y_m + along * (to.y_m - from.y_m);
    for (int iy = truth.iy_of(y) - reach; iy <= truth.iy_of(y) + reach; ++iy) {
      for (int ix = truth.ix_of(x) - reach; ix <= truth.ix_of(x) + reach; ++ix) {
        if (truth.at(ix, iy) == ColumnState::occupied)
          least = std::min(least, distance_to_column_m(truth, ix, iy, x, y));
      }
    }
  }
  return least;
}

}  // namespace ensonify
