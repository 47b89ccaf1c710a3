// Range scans against liboctomap, against definitions, and from several threads.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/insert_scan.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr LogOddsStep octomap_step = {.free = -405, .occupied = 847};
constexpr double resolution_m = 0.1;

/// Points all around at random ranges, in single precision as OctoMap keeps them.
RangeScan random_scan(std::uint64_t seed, int points = 400, double reach_m = 4) {
  RandomSequence random(RandomKey::from_seed(seed));
  const auto coordinate = [&](double half) {
    return static_cast<double>(static_cast<float>(random.uniform(-half, half)));
  };
  RangeScan scan;
  scan.origin_m = {coordinate(0.5), coordinate(0.5), coordinate(0.5)};
  for (int i = 0; i < points; ++i)
    scan.points_m.emplace_back(coordinate(reach_m), coordinate(reach_m), coordinate(reach_m));
  return scan;
}

LogOddsGrid grid_of_scans(const std::vector<RangeScan>& scans, const ScanOptions& options,
                          const GridFrame& frame = box_frame({-5, -5, -5}, {5, 5, 5}, resolution_m)) {
  LogOddsGrid grid(frame);
  ScanScratch scratch;
  for (const RangeScan& scan : scans) insert_scan(scan, options, grid, scratch);
  return grid;
}

octomap::OcTree octomap_of(const std::vector<RangeScan>& scans, double max_range_m) {
  octomap::OcTree tree(resolution_m);
  tree.setProbHit(1 / (1 + std::exp(-0.847)));
  tree.setProbMiss(1 / (1 + std::exp(0.405)));
  tree.setClampingThresMin(1e-9);
  tree.setClampingThresMax(1 - 1e-9);
  for (const RangeScan& scan : scans) {
    octomap::Pointcloud cloud;
    for (const Vec3& p : scan.points_m) {
      cloud.push_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    }
    const Eigen::Vector3f o = scan.origin_m.cast<float>();
    tree.insertPointCloud(cloud, {o.x(), o.y(), o.z()}, max_range_m, false, false);
  }
  return tree;
}

/// 1 occupied, -1 free, 0 unknown.
int verdict(const octomap::OcTree& tree, const Vec3& centre_m) {
  const octomap::OcTreeNode* node = tree.search(centre_m.x(), centre_m.y(), centre_m.z());
  return !node ? 0 : node->getLogOdds() > 0 ? 1 : -1;
}
int verdict(MilliLogOdds v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

struct Agreement {
  std::size_t known = 0;
  std::size_t different = 0;
};

Agreement agreement(const LogOddsGrid& ours, const octomap::OcTree& theirs) {
  Agreement a;
  for_each_cell(ours.frame(), [&](const Cell& c) {
    const int expected = verdict(theirs, ours.frame().centre_m(c[0], c[1], c[2]));
    a.known += expected != 0;
    a.different += verdict(ours.at(c)) != expected;
  });
  return a;
}

TEST(Scans, SameVerdictInEveryCellAsOctoMap) {
  std::vector<RangeScan> scans;
  for (std::uint64_t s = 0; s < 12; ++s) scans.push_back(random_scan(s));
  const Agreement a =
      agreement(grid_of_scans(scans, {.rule = LineRule::exact_every_ray, .step = octomap_step}), octomap_of(scans, -1));
  EXPECT_GT(a.known, 60000U);
  EXPECT_EQ(a.different, 0U);
}

TEST(Scans, SameLogOddsAsOctoMapInTheEnd) {
  std::vector<RangeScan> scans;
  for (std::uint64_t s = 20; s < 24; ++s) scans.push_back(random_scan(s));
  const LogOddsGrid ours = grid_of_scans(scans, {.rule = LineRule::exact_every_ray, .step = octomap_step});
  const octomap::OcTree theirs = octomap_of(scans, -1);
  for_each_cell(ours.frame(), [&](const Cell& c) {
    const Vec3 p = ours.frame().centre_m(c[0], c[1], c[2]);
    const octomap::OcTreeNode* node = theirs.search(p.x(), p.y(), p.z());
    ASSERT_NEAR(ours.at(c), node ? 1000 * node->getLogOdds() : 0, 0.01);
  });
}

TEST(Scans, MaximumRangeAsOctoMap) {
  std::vector<RangeScan> scans;
  for (std::uint64_t s = 40; s < 46; ++s) scans.push_back(random_scan(s));
  const double max_range_m = 2.5;
  const Agreement a = agreement(grid_of_scans(scans, {.max_range_m = max_range_m, .step = octomap_step}),
                                octomap_of(scans, max_range_m));
  EXPECT_GT(a.known, 20000U);
  EXPECT_EQ(a.different, 0U);
}

/// The stated difference: Bresenham's line misses cells that a ray only cuts a corner of, so it frees fewer, and, since
/// it joins centres of cells, a tenth elsewhere in a sparse scan; what it occupies is the same.
TEST(Scans, BresenhamFreesFewerCellsAndOccupiesTheSame) {
  const std::vector<RangeScan> scans = {random_scan(7, 2000)};
  const LogOddsGrid thin = grid_of_scans(scans, {.rule = LineRule::bresenham_once_an_end});
  const LogOddsGrid exact = grid_of_scans(scans, {.rule = LineRule::exact_every_ray});
  std::size_t thin_free = 0;
  std::size_t exact_free = 0;
  std::size_t only_thin = 0;
  for_each_cell(thin.frame(), [&](const Cell& c) {
    ASSERT_EQ(thin.at(c) > 0, exact.at(c) > 0);
    thin_free += thin.at(c) < 0;
    exact_free += exact.at(c) < 0;
    only_thin += thin.at(c) < 0 && exact.at(c) == 0;
  });
  EXPECT_GT(thin_free, exact_free / 2);
  EXPECT_LT(thin_free, exact_free);
  EXPECT_LT(static_cast<double>(only_thin), 0.15 * static_cast<double>(thin_free));
}

TEST(Scans, RaysToOneCellAreOneLine) {
  RangeScan scan;
  for (int i = 0; i < 50; ++i) scan.points_m.emplace_back(3.01 + 0.001 * i, 0.05, 0.05);
  const LogOddsGrid grid = grid_of_scans({scan}, {.rule = LineRule::bresenham_once_an_end});
  EXPECT_EQ(grid.at({80, 50, 50}), LogOddsStep{}.occupied);
  for (int x = 50; x < 80; ++x) EXPECT_EQ(grid.at({x, 50, 50}), LogOddsStep{}.free);
  EXPECT_EQ(grid.at({81, 50, 50}), 0);
}

TEST(Scans, OccupiedWinsOverRaysThatPassInAnyOrder) {
  const Vec3 near(1.05, 0.05, 0.05);
  const Vec3 far(3.05, 0.05, 0.05);
  for (const LineRule rule : {LineRule::bresenham_once_an_end, LineRule::exact_every_ray}) {
    const RangeScan one = {Vec3(0.05, 0.05, 0.05), {near, far}};
    const RangeScan other = {Vec3(0.05, 0.05, 0.05), {far, near}};
    const LogOddsGrid a = grid_of_scans({one}, {.rule = rule});
    EXPECT_TRUE(same(a, grid_of_scans({other}, {.rule = rule})));
    EXPECT_EQ(a.at({60, 50, 50}), LogOddsStep{}.occupied);
    EXPECT_EQ(a.at({70, 50, 50}), LogOddsStep{}.free);
    EXPECT_EQ(a.at({80, 50, 50}), LogOddsStep{}.occupied);
  }
}

/// A hit in the last cell of a miss occupies it; a miss alone leaves it.
TEST(Scans, AMissOccupiesNothingAndLeavesItsLastCell) {
  const Vec3 origin(0.05, 0.05, 0.05);
  for (const LineRule rule : {LineRule::bresenham_once_an_end, LineRule::exact_every_ray}) {
    const RangeScan miss = {origin, {Vec3(9.05, 0.05, 0.05)}};
    const RangeScan both = {origin, {Vec3(9.05, 0.05, 0.05), Vec3(2.04, 0.05, 0.05)}};
    const ScanOptions options = {.rule = rule, .max_range_m = 2};
    EXPECT_EQ(grid_of_scans({miss}, options).at({69, 50, 50}), LogOddsStep{}.free);
    EXPECT_EQ(grid_of_scans({miss}, options).at({70, 50, 50}), 0);
    EXPECT_EQ(grid_of_scans({both}, options).at({70, 50, 50}), LogOddsStep{}.occupied);
  }
}

TEST(Scans, PartsOutsideTheGridAreDropped) {
  const GridFrame whole = box_frame({-5, -5, -5}, {5, 5, 5}, resolution_m);
  const GridFrame part = box_frame({-1, 0.5, -5}, {3.3, 2.2, 1.1}, resolution_m);
  const std::vector<RangeScan> scans = {random_scan(61), random_scan(62)};
  for (const LineRule rule : {LineRule::bresenham_once_an_end, LineRule::exact_every_ray}) {
    const LogOddsGrid all = grid_of_scans(scans, {.rule = rule}, whole);
    const LogOddsGrid some = grid_of_scans(scans, {.rule = rule}, part);
    for_each_cell(part, [&](const Cell& c) { ASSERT_EQ(some.at(c), all.at({c[0] + 40, c[1] + 55, c[2]})); });
  }
}

TEST(Scans, SameFromOneTwoAndEightThreads) {
  for (const LineRule rule : {LineRule::bresenham_once_an_end, LineRule::exact_every_ray}) {
    std::vector<LogOddsGrid> grids;
    for (const std::size_t threads : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      grids.push_back(grid_of_scans({random_scan(70, 5000), random_scan(71, 5000)}, {.rule = rule}));
    }
    EXPECT_TRUE(same(grids[0], grids[1]));
    EXPECT_TRUE(same(grids[0], grids[2]));
  }
}

TEST(Scans, PointsThatAreNoNumbersAreLeftOutAndOriginsRefused) {
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  const RangeScan scan = {Vec3::Zero(), {Vec3(nan, 0, 0), Vec3(1, inf, 0), Vec3(1e300, 0, 0), Vec3(1, 0, 0)}};
  for (const LineRule rule : {LineRule::bresenham_once_an_end, LineRule::exact_every_ray}) {
    LogOddsGrid grid(box_frame({-5, -5, -5}, {5, 5, 5}, resolution_m));
    EXPECT_EQ(insert_scan(scan, {.rule = rule}, grid), 1U);
    EXPECT_EQ(insert_scan({}, {.rule = rule}, grid), 0U);
    EXPECT_EQ(insert_scan({Vec3(1e5, 0, 0), {Vec3(1e5, 1, 0)}}, {.rule = rule}, grid), 1U);
    EXPECT_THROW(insert_scan({Vec3(nan, 0, 0), {}}, {.rule = rule}, grid), DataError);
    EXPECT_THROW(insert_scan({Vec3(1e300, 0, 0), {}}, {.rule = rule}, grid), DataError);
    EXPECT_THROW(insert_scan(scan, {.rule = rule, .max_range_m = nan}, grid), ConfigError);
    EXPECT_THROW(insert_scan(scan, {.rule = rule, .max_range_m = 0}, grid), ConfigError);
    EXPECT_THROW(insert_scan({}, {.rule = rule, .step = {.free = 1, .occupied = 1}}, grid), ConfigError);
  }
}

}  // namespace
}  // namespace ensonify
