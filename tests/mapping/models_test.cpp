// Each inverse sensor model against its definition, cell by cell, in double precision and without tricks.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>
#include <optional>

#include "ensonify/mapping/bresenham.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double threshold = 25;

std::uint8_t grey(const PosedImage& ping, int bin, int beam) {
  return std::get<Image2<std::uint8_t>>(ping.grey)(bin, beam);
}

std::vector<PosedImage> askew_pings() {
  SonarGeometry narrow = sonar(60, 14, 3, 120, 64);
  SonarGeometry uneven = sonar(120, 30, 2.6, 60, 40, 0);
  for (double& a : uneven.beam_azimuth_rad) a = std::asin(std::sin(a) * 0.9);
  const SonarGeometry behind = sonar(300, 60, 2, 50, 150, 0.5);
  std::vector<PosedImage> pings;
  int i = 0;
  for (const SonarGeometry& g : {narrow, uneven, behind, narrow, uneven, behind}) {
    const Pose pose = pose_from_xyz_rpy({0.31 - 0.1 * i, 0.2, -0.17}, 0.4 * i, 0.3 - 0.2 * i, 1.3 * i + 0.2);
    pings.push_back(noise_image(g, pose, static_cast<std::uint64_t>(++i)));
  }
  return pings;
}

GridFrame frame_around() { return box_frame({-3.05, -2.9, -2.6}, {3.3, 3.1, 2.7}, 0.05); }

/// Strongest pixel within half a footprint of a pixel; with `before`, of those before them in their beams too.
int pooled(const PosedImage& ping, int bin, int beam, double half_m, bool before) {
  const SonarGeometry& g = ping.geometry;
  int most = 0;
  for (int b = 0; b < g.beams(); ++b) {
    const double across = std::abs(g.beam_azimuth_rad[b] - g.beam_azimuth_rad[beam]) * g.bin_centre_m(bin);
    if (b != beam && across > half_m) continue;
    for (int k = 0; k < g.range_bins; ++k) {
      const double ahead = (k - bin) * g.bin_size_m();
      if (k != bin && (ahead > half_m + 1e-9 || (!before && ahead < -half_m - 1e-9))) continue;
      most = std::max(most, static_cast<int>(grey(ping, k, b)));
    }
  }
  return most;
}

enum class Expected { none, free, occupied, either };

/// By the definition; `either` where the centre lies at a border to single precision.
Expected expected_of_arc(const PosedImage& ping, const ArcShape& shape, bool shadow, const Vec3& centre,
                         double cell_m) {
  const SonarGeometry& g = ping.geometry;
  const Spherical s = to_spherical(ping.T_world_sonar.inverse() * centre);
  constexpr double near = 4e-6;
  const double half_elevation = 0.5 * shape.elevation_share * g.elevation_fov_rad;
  const std::vector<double> edges = g.beam_edges_rad();
  for (const double e : edges) {
    if (std::abs(s.azimuth_rad - e) < near) return Expected::either;
  }
  const double bins = (s.range_m - g.range_min_m) / g.bin_size_m();
  if (std::abs(bins - std::round(bins)) < 1e-4) return Expected::either;
  if (std::abs(std::abs(s.elevation_rad) - half_elevation) < near) return Expected::either;
  const auto bin = g.bin_of(s.range_m);
  const auto beam = g.beam_of(s.azimuth_rad);
  if (!bin || !beam || std::abs(s.elevation_rad) > half_elevation) return Expected::none;
  const double half_m = 0.5 * shape.footprint_cells * cell_m;
  if (pooled(ping, *bin, *beam, half_m, false) >= threshold) return Expected::occupied;
  return shadow && pooled(ping, *bin, *beam, half_m, true) >= threshold ? Expected::none : Expected::free;
}

void expect_arcs(const InverseModel& model, const ArcShape& shape, bool shadow) {
  for (const PosedImage& ping : askew_pings()) {
    LogOddsGrid grid(frame_around());
    integrate_ping(ping, threshold, model, grid);
    std::map<std::pair<int, int>, Expected> known;  // pooling by definition is slow: once a pixel
    std::size_t undecided = 0;
    std::size_t marked = 0;
    for_each_cell(grid.frame(), [&](const Cell& c) {
      const Vec3 centre = grid.frame().centre_m(c[0], c[1], c[2]);
      const Spherical s = to_spherical(ping.T_world_sonar.inverse() * centre);
      if (s.range_m > ping.geometry.range_max_m + 0.1) {
        ASSERT_EQ(grid.at(c), 0);
        return;
      }
      if ((c[0] + 3 * c[1] + 5 * c[2]) % 7 != 0) return;
      const Expected e = expected_of_arc(ping, shape, shadow, centre, grid.frame().resolution_m);
      const Expected is = grid.at(c) > 0 ? Expected::occupied : grid.at(c) < 0 ? Expected::free : Expected::none;
      undecided += e == Expected::either;
      marked += is != Expected::none;
      ASSERT_TRUE(e == Expected::either || e == is)
          << centre.transpose() << ' ' << static_cast<int>(e) << ' ' << static_cast<int>(is);
    });
    EXPECT_GT(marked, 200U);
    EXPECT_LT(static_cast<double>(undecided), 0.02 * static_cast<double>(grid.frame().cells()) / 7);
  }
}

TEST(Models, ArcIsItsDefinition) {
  expect_arcs(Arc{}, {}, false);
  const ArcShape pixel = {.footprint_cells = 0, .elevation_share = 0.6};
  expect_arcs(Arc{.step = {}, .shape = pixel}, pixel, false);
}

TEST(Models, ArcShadowIsItsDefinition) {
  expect_arcs(ArcShadow{}, {}, true);
  const ArcShape wide = {.footprint_cells = 3, .elevation_share = 1};
  expect_arcs(ArcShadow{.step = {}, .shape = wide}, wide, true);
}

TEST(Models, CarveMarksAsArcShadowInOnePing) { expect_arcs(Carve{}, {}, true); }

TEST(Models, PointsAreTheirDefinition) {
  for (const PosedImage& ping : askew_pings()) {
    const GridFrame frame = frame_around();
    LogOddsGrid grid(frame);
    integrate_ping(ping, threshold, Points{}, grid);
    std::map<Cell, int> strongest;
    const SonarGeometry& g = ping.geometry;
    const Cell size = frame.size;
    const StridedBox all = {box_of(frame), {}, {1, size[0], std::ptrdiff_t{size[0]} * size[1]}};
    for (int b = 0; b < g.beams(); ++b) {
      const auto cell = [&](int k) {
        return frame.cell_of(ping.T_world_sonar * from_spherical({g.bin_centre_m(k), g.beam_azimuth_rad[b], 0}));
      };
      walk_bresenham(frame.cell_of(ping.T_world_sonar.translation()), cell(g.range_bins - 1), LineEnd::included, all,
                     [&](std::ptrdiff_t o) {
                       const int i = static_cast<int>(o);
                       strongest.try_emplace({i % size[0], i / size[0] % size[1], i / size[0] / size[1]}, 0);
                     });
      for (int k = 0; k < g.range_bins; ++k) {
        int& z = strongest.try_emplace(cell(k), 0).first->second;
        z = std::max(z, static_cast<int>(grey(ping, k, b)));
      }
    }
    for_each_cell(frame, [&](const Cell& c) {
      const auto z = strongest.find(c);
      const int expected = z == strongest.end() ? 0 : z->second >= threshold ? 2944 : -201;
      ASSERT_EQ(grid.at(c), expected);
    });
  }
}

TEST(Models, OraclePutsEchoesWhereTheyAreAndFreesTheWayThere) {
  SonarGeometry g = sonar(40, 20, 4, 100, 21);
  PosedImage ping{Image2<std::uint8_t>(100, 21), g, Pose::Identity(),
                  Image2<float>(100, 21, std::numeric_limits<float>::quiet_NaN())};
  std::get<Image2<std::uint8_t>>(ping.grey)(60, 10) = 100;
  ping.elevation_rad(60, 10) = static_cast<float>(radians(12));  // beyond the nominal field of view of +-10
  LogOddsGrid grid(box_frame({-1, -3, -2}, {5, 3, 2}, 0.05));
  integrate_ping(ping, threshold, Oracle{}, grid);
  const auto at = [&](double range_m, double azimuth, double elevation_deg) {
    return grid.at(grid.frame().cell_of(from_spherical({range_m, azimuth, radians(elevation_deg)})));
  };
  const double r = g.bin_centre_m(60);
  EXPECT_GT(at(r, 0, 12), 0);
  EXPECT_LT(at(0.9 * r, 0, 12), 0) << "the line to it";
  EXPECT_LT(at(0.9 * r, 0, -8), 0) << "the arcs before it";
  EXPECT_EQ(at(r, 0, -8), 0) << "no smear over the arc";
  EXPECT_EQ(at(r + 0.3, 0, 2), 0) << "its shadow";
  EXPECT_LT(at(r + 0.3, radians(8), 2), 0) << "another beam";
  EXPECT_NEAR(volume_m3(grid, is_occupied), std::pow(0.05, 3), 1e-9);
}

TEST(Models, AllReturnsOfABeamCount) {
  const SonarGeometry g = sonar(40, 20, 4, 100, 21);
  PosedImage ping{Image2<float>(100, 21), g, Pose::Identity(), Image2<float>(100, 21, 0.0F)};
  for (const int bin : {30, 50, 70}) {
    for (const int beam : {9, 10, 11}) std::get<Image2<float>>(ping.grey)(bin, beam) = 99.5F;
  }
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    LogOddsGrid grid(box_frame({-1, -3, -2}, {5, 3, 2}, 0.05));
    integrate_ping(ping, threshold, inverse_model_named(kind), grid);
    for (const int bin : {30, 50, 70}) {
      EXPECT_GT(grid.at(grid.frame().cell_of({g.bin_centre_m(bin), 0, 0})), 0) << kind << ' ' << bin;
    }
  }
}

TEST(Models, SameFromOneTwoAndEightThreadsAndInAnyOrder) {
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    std::vector<LogOddsGrid> grids;
    for (const std::size_t threads : {1, 2, 8, 0}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::max<std::size_t>(1, threads));
      grids.emplace_back(frame_around());
      const std::vector<PosedImage> pings = askew_pings();
      MarkBox<Mark> scratch;
      for (std::size_t i = 0; i < pings.size(); ++i) {
        const PosedImage& ping = pings[threads == 0 ? pings.size() - 1 - i : i];
        integrate_ping(ping, threshold, inverse_model_named(kind), grids.back(), scratch);
      }
    }
    for (std::size_t i = 1; i < grids.size(); ++i) EXPECT_TRUE(same(grids[0], grids[i])) << kind << i;
  }
}

TEST(Models, AtThresholdZeroEverythingMarkedIsOccupied) {
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    LogOddsGrid grid(frame_around());
    for (const PosedImage& ping : askew_pings()) integrate_ping(ping, 0, inverse_model_named(kind), grid);
    EXPECT_EQ(volume_m3(grid, is_free), 0) << kind;
    EXPECT_GT(volume_m3(grid, is_occupied), 0.1) << kind;
  }
}

TEST(Models, AMapInTwoDimensionsIsALayer) {
  const PosedImage ping = noise_image(sonar(60, 14, 3, 120, 64), pose_from_xyz_rpy({0, 0, -1.02}, 0, 0, 0.4), 4);
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    LogOddsGrid layer(box_frame({-1, -3, -1.05}, {4, 3, -1.0}, 0.05));
    LogOddsGrid solid(box_frame({-1, -3, -2.05}, {4, 3, 0}, 0.05));
    integrate_ping(ping, threshold, inverse_model_named(kind), layer);
    integrate_ping(ping, threshold, inverse_model_named(kind), solid);
    ASSERT_EQ(layer.frame().size[2], 1);
    std::size_t known = 0;
    for_each_cell(layer.frame(), [&](const Cell& c) {
      ASSERT_EQ(layer.at(c), solid.at({c[0], c[1], 20})) << kind;
      known += layer.at(c) != 0;
    });
    EXPECT_GT(known, 300U) << kind;
  }
}

}  // namespace
}  // namespace ensonify
