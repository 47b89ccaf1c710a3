#include "ensonify/sim/observe.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr float miss = std::numeric_limits<float>::infinity();

SonarGeometry geometry(double range_min_m, double range_max_m, double width_deg, double height_deg, int beams = 256) {
  SonarGeometry g;
  g.range_min_m = range_min_m;
  g.range_max_m = range_max_m;
  g.range_bins = 256;
  for (int b = 0; b < beams; ++b) g.beam_azimuth_rad.push_back(radians(width_deg) * (0.5 - (b + 0.5) / beams));
  g.elevation_fov_rad = radians(height_deg);
  return g;
}

float elevation_of(const PingTruth& truth, int row, int column) {
  return truth.lowest_elevation_rad[column] + static_cast<float>(row) * truth.elevation_step_rad;
}

/// Rays wider than the frustum by a tenth; `range_m(direction)` gives the first hit.
PingTruth truth_of(const SonarGeometry& g, const std::function<double(double, double)>& range_m, int rows = 64,
                   int columns = 512) {
  PingTruth truth;
  const double width = 1.1 * (g.beam_edges_rad().front() - g.beam_edges_rad().back());
  const double height = 1.1 * g.elevation_fov_rad;
  truth.elevation_step_rad = static_cast<float>(height / rows);
  for (int c = 0; c < columns; ++c) {
    const double u = 1 - 2 * (c + 0.5) / columns;  // uniform in the sine, as real beam tables are
    truth.ray_azimuth_rad.push_back(static_cast<float>(std::asin(u * std::sin(0.5 * width))));
    const double stagger = 0.25 * (c % 3 - 1);  // neighbouring columns look at different heights
    truth.lowest_elevation_rad.push_back(static_cast<float>(height * ((0.5 + stagger) / rows - 0.5)));
  }
  truth.first_hit_range_m = Image2<float>(rows, columns);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double range = range_m(truth.ray_azimuth_rad[c], elevation_of(truth, r, c));
      truth.first_hit_range_m(r, c) = range <= g.range_max_m ? static_cast<float>(range) : miss;
    }
  }
  return truth;
}

OccupancyGrid empty_grid(double half_m, double resolution_m) {
  const int n = static_cast<int>(std::round(2 * half_m / resolution_m));
  OccupancyGrid grid;
  grid.frame = {.origin_m = Vec3::Constant(-half_m), .resolution_m = resolution_m, .size = {n, n, n}};
  grid.occupancy.assign(grid.frame.cells(), 0);
  return grid;
}

double observed_m3(const OccupancyGrid& grid) {
  return std::pow(grid.frame.resolution_m, 3) *
         static_cast<double>(std::count(grid.observable.begin(), grid.observable.end(), 1));
}

template <typename Visit>
void for_each_cell(const OccupancyGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.frame.size[2]; ++z) {
    for (int y = 0; y < grid.frame.size[1]; ++y) {
      for (int x = 0; x < grid.frame.size[0]; ++x) visit(x, y, z, grid.frame.index(x, y, z));
    }
  }
}

TEST(Observe, EmptyFrustumHasItsClosedFormVolume) {
  for (const double width_deg : {60.0, 130.0, 220.0}) {
    const SonarGeometry g = geometry(0.5, 4.5, width_deg, 20);
    OccupancyGrid grid = empty_grid(5, 0.05);
    const Pose pose = pose_from_xyz_rpy({0.1, -0.2, 0.1}, 0.3, 0.4, 1.0);
    mark_observed(truth_of(g, [](double, double) { return miss; }), g, pose, grid);
    const double expected = (std::pow(4.5, 3) - std::pow(0.5, 3)) / 3 * radians(width_deg) * 2 * std::sin(radians(10));
    EXPECT_NEAR(observed_m3(grid) / expected, 1, 0.005) << width_deg;
  }
}

TEST(Observe, SameAsTheDefinitionCellByCell) {
  const SonarGeometry g = geometry(0.3, 2.4, 70, 30, 64);
  const PingTruth truth = truth_of(
      g, [](double a, double e) { return 1.8 + std::sin(9 * a) + 3 * e; }, 16, 96);
  OccupancyGrid grid = empty_grid(3, 0.1);
  const Pose pose = pose_from_xyz_rpy({-0.5, 0.3, 0.2}, -0.7, -0.3, 2.5);
  mark_observed(truth, g, pose, grid);
  for_each_cell(grid, [&](int x, int y, int z, std::size_t i) {
    const Spherical s = to_spherical(pose.inverse() * grid.frame.centre_m(x, y, z));
    const auto nearest = [](int count, const auto& angle_of, double angle) {
      int best = 0;
      for (int k = 1; k < count; ++k) {
        if (std::abs(angle_of(k) - angle) < std::abs(angle_of(best) - angle)) best = k;
      }
      return best;
    };
    const int column = nearest(
        truth.first_hit_range_m.columns(), [&](int c) { return truth.ray_azimuth_rad[c]; }, s.azimuth_rad);
    const int row = nearest(
        truth.first_hit_range_m.rows(), [&](int r) { return elevation_of(truth, r, column); }, s.elevation_rad);
    const bool inside = s.range_m >= 0.3 && s.range_m <= 2.4 && std::abs(s.azimuth_rad) <= radians(35) &&
                        std::abs(s.elevation_rad) <= radians(15);
    const bool clear = s.range_m < truth.first_hit_range_m(row, column);
    ASSERT_EQ(grid.observable[i] != 0, inside && clear);
  });
}

/// A wall of surface cells with interior behind it, 3 m ahead of a sonar at the origin: within the cells, and on
/// their border, rounded to its near side.
TEST(Observe, WallIsSeenAndNothingBehindIt) {
  for (const double wall_m : {3.02, 3.0 - 2e-6}) {
    const SonarGeometry g = geometry(0.2, 4.8, 60, 12);
    OccupancyGrid grid = empty_grid(5, 0.1);
    for_each_cell(
        grid, [&](int x, int, int, std::size_t i) { grid.occupancy[i] = x == 80 ? 1 : (x > 80 && x < 84 ? 2 : 0); });
    const PingTruth truth = truth_of(g, [&](double a, double e) { return wall_m / (std::cos(a) * std::cos(e)); });
    mark_observed(truth, g, Pose::Identity(), grid);
    std::size_t seen_wall = 0;
    for_each_cell(grid, [&](int x, int y, int z, std::size_t i) {
      ASSERT_TRUE(x <= 80 || grid.observable[i] == 0) << x;
      if (x != 80) return;
      seen_wall += grid.observable[i];
      const Vec3 p = grid.frame.centre_m(x, y, z);
      const Spherical s = to_spherical({wall_m, p.y(), p.z()});
      const bool well_inside = std::abs(s.azimuth_rad) < radians(29) && std::abs(s.elevation_rad) < radians(5);
      const bool well_outside = std::abs(s.azimuth_rad) > radians(31.5) || std::abs(s.elevation_rad) > radians(7.5);
      ASSERT_TRUE(!well_inside || grid.observable[i] == 1);
      ASSERT_TRUE(!well_outside || grid.observable[i] == 0);
    });
    EXPECT_NEAR(static_cast<double>(seen_wall), 2 * 30 * std::tan(radians(30)) * 2 * 32 * std::tan(radians(6)), 80);
  }
}

TEST(Observe, ASecondPingOnlyAddsAndSurfaceWithoutHitStaysUnseen) {
  const SonarGeometry g = geometry(0.2, 4.8, 60, 12);
  OccupancyGrid grid = empty_grid(5, 0.2);
  grid.occupancy[grid.frame.index(35, 25, 25)] = 1;
  const PingTruth nothing = truth_of(g, [](double, double) { return miss; });
  mark_observed(nothing, g, Pose::Identity(), grid);
  EXPECT_EQ(grid.observable[grid.frame.index(35, 25, 25)], 0);
  const auto first = grid.observable;
  mark_observed(nothing, g, pose_from_xyz_rpy({0, 0, 0}, 0, 0, 2), grid);
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_GE(grid.observable[i], first[i]);
  EXPECT_GT(observed_m3(grid), 0);
}

TEST(Observe, FarFromTheGridNothingHappens) {
  const SonarGeometry g = geometry(0.2, 4.8, 60, 12);
  OccupancyGrid grid = empty_grid(1, 0.1);
  mark_observed(truth_of(g, [](double, double) { return 2.0; }), g, pose_from_xyz_rpy({1e7, 0, 0}, 0, 0, 0), grid);
  EXPECT_EQ(observed_m3(grid), 0);
}

TEST(Observe, SizesThatDoNotMatchAreRefused) {
  const SonarGeometry g = geometry(0.2, 4.8, 60, 12);
  PingTruth truth = truth_of(g, [](double, double) { return 2.0; });
  truth.ray_azimuth_rad.pop_back();
  OccupancyGrid grid = empty_grid(1, 0.1);
  EXPECT_THROW(mark_observed(truth, g, Pose::Identity(), grid), ConfigError);
  EXPECT_THROW(mark_observed({}, g, Pose::Identity(), grid), ConfigError);
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = std::nan("");
  EXPECT_THROW(mark_observed(truth_of(g, [](double, double) { return 2.0; }), g, nowhere, grid), ConfigError);
}

}  // namespace
}  // namespace ensonify
