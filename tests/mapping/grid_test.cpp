#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr LogOddsStep step;

MarkBox<Mark> one_mark(const Cell& cell, Mark mark) {
  MarkBox<Mark> marks;
  marks.reset({cell, {cell[0] + 1, cell[1] + 1, cell[2] + 1}});
  marks.data()[marks.layout().offset(cell)] = mark;
  return marks;
}

LogOddsGrid small_grid(const LogOddsLimits& limits = {}) {
  return LogOddsGrid(box_frame({0, 0, 0}, {2, 1.5, 1}, 0.1), limits);
}

TEST(LogOdds, TheNumbersOfThePaperWithOurSign) {
  EXPECT_EQ(milli_log_odds(0.95), 2944);
  EXPECT_EQ(milli_log_odds(0.45), -201);
  EXPECT_EQ(step.occupied, milli_log_odds(1 - 0.05));
  EXPECT_EQ(step.free, milli_log_odds(1 - 0.55));
  EXPECT_NEAR(probability_occupied(2944), 0.95, 1e-4);
  for (const double p : {0.0, 1.0, -0.1, std::nan("")}) EXPECT_THROW(milli_log_odds(p), ConfigError);
}

TEST(LogOddsGrid, SeventyThousandPingsIntoOneCellCountRight) {
  LogOddsGrid grid = small_grid();
  const Cell cell = {19, 14, 9};
  const MarkBox<Mark> free = one_mark(cell, Mark::free);
  const MarkBox<Mark> echo = one_mark(cell, Mark::occupied);
  for (int i = 0; i < 70000; ++i) grid.apply(i % 10 ? free : echo, step);
  EXPECT_EQ(grid.at(cell), 63000 * step.free + 7000 * step.occupied);
  EXPECT_EQ(grid.at({18, 14, 9}), 0);
}

TEST(LogOddsGrid, SumsSaturateAndLimitsHold) {
  const Cell cell = {3, 3, 3};
  LogOddsGrid grid = small_grid();
  const MilliLogOdds top = std::numeric_limits<MilliLogOdds>::max();
  const MilliLogOdds bottom = std::numeric_limits<MilliLogOdds>::min();
  grid.set(cell, top - 10);
  grid.apply(one_mark(cell, Mark::occupied), step);
  EXPECT_EQ(grid.at(cell), top);
  grid.set(cell, bottom + 10);
  grid.apply(one_mark(cell, Mark::free), step);
  EXPECT_EQ(grid.at(cell), bottom);
  grid.apply(one_mark(cell, Mark::free), {.free = bottom, .occupied = top});
  EXPECT_EQ(grid.at(cell), bottom);

  LogOddsGrid clamped = small_grid({.lowest = -500, .highest = 3000});
  for (int i = 0; i < 4; ++i) clamped.apply(one_mark(cell, Mark::free), step);
  EXPECT_EQ(clamped.at(cell), -500);
  for (int i = 0; i < 4; ++i) clamped.apply(one_mark(cell, Mark::occupied), step);
  EXPECT_EQ(clamped.at(cell), 3000);
  clamped.apply(one_mark(cell, Mark::free), {.free = -9999, .occupied = 9999});
  EXPECT_EQ(clamped.at(cell), 2500);  // a step is no longer than the limit on its side
  clamped.set(cell, 99999);
  EXPECT_EQ(clamped.at(cell), 3000);
}

TEST(LogOddsGrid, OnceFreedStaysFreeInAnyOrder) {
  const Cell cell = {1, 2, 3};
  const Mark looks[] = {Mark::occupied, Mark::occupied, Mark::free, Mark::free, Mark::occupied};
  for (int rotation = 0; rotation < 5; ++rotation) {
    LogOddsGrid grid = small_grid();
    for (int i = 0; i < 5; ++i) {
      grid.apply(one_mark(cell, looks[(i + rotation) % 5]), step, UpdateLaw::freed_for_good);
    }
    EXPECT_EQ(grid.at(cell), 2 * step.free) << rotation;
  }
  LogOddsGrid echoes = small_grid();
  for (int i = 0; i < 3; ++i) echoes.apply(one_mark(cell, Mark::occupied), step, UpdateLaw::freed_for_good);
  EXPECT_EQ(echoes.at(cell), 3 * step.occupied);
}

TEST(LogOddsGrid, AnEmptyBigBoxCostsLittleAndTheWorstIsKnown) {
  const GridFrame big = {.origin_m = Vec3::Zero(), .resolution_m = 0.05, .size = {2000, 2000, 1000}};
  LogOddsGrid grid(big);
  EXPECT_LT(grid.bytes(), 70'000'000U);
  EXPECT_GE(LogOddsGrid::bytes_at_worst(big), big.cells() * (sizeof(MilliLogOdds) + 1));
  EXPECT_LE(static_cast<double>(LogOddsGrid::bytes_at_worst(big)), 1.01 * 5 * static_cast<double>(big.cells()));
  grid.set({1999, 1999, 999}, 7);
  EXPECT_EQ(grid.at({1999, 1999, 999}), 7);
  EXPECT_EQ(grid.at({2000, 0, 0}), 0);
  EXPECT_EQ(grid.at({-1, 0, 0}), 0);
  EXPECT_THROW(grid.set({2000, 0, 0}, 1), ConfigError);
}

TEST(LogOddsGrid, FramesAndStepsThatMakeNoSenseAreRefused) {
  const GridFrame good = {.origin_m = Vec3::Zero(), .resolution_m = 0.1, .size = {4, 4, 4}};
  const auto refused = [&](auto change) {
    GridFrame frame = good;
    change(frame);
    EXPECT_THROW(LogOddsGrid{frame}, ConfigError);
    EXPECT_THROW(LogOddsGrid::bytes_at_worst(frame), ConfigError);
  };
  refused([](GridFrame& f) { f.size[1] = 0; });
  refused([](GridFrame& f) { f.size[1] = -3; });
  refused([](GridFrame& f) { f.size = {65536, 65536, 65536}; });
  refused([](GridFrame& f) { f.resolution_m = 0; });
  refused([](GridFrame& f) { f.resolution_m = std::nan(""); });
  refused([](GridFrame& f) { f.origin_m.x() = std::nan(""); });
  EXPECT_THROW(LogOddsGrid(good, {.lowest = 0, .highest = 5}), ConfigError);
  LogOddsGrid grid(good);
  EXPECT_THROW(grid.apply(one_mark({1, 1, 1}, Mark::free), {.free = 5, .occupied = 5}), ConfigError);
  EXPECT_THROW(grid.apply(one_mark({1, 1, 1}, Mark::free), {.free = -5, .occupied = -5}), ConfigError);
}

TEST(MapConversion, ThereAndBack) {
  LogOddsGrid grid = small_grid();
  RandomSequence random(RandomKey::from_seed(3));
  for_each_cell(grid.frame(), [&](const Cell& c) {
    if (random.uniform() < 0.3) grid.set(c, random.below(2'000'000) - 1'000'000);
  });
  const LogOddsMap map = dense_map(grid);
  ASSERT_EQ(map.log_odds.size(), grid.frame().cells());
  EXPECT_TRUE(same(grid_of(map), grid));
  const OccupancyGrid occupancy = occupancy_of(map);
  for_each_cell(grid.frame(), [&](const Cell& c) {
    const std::size_t i = grid.frame().index(c[0], c[1], c[2]);
    ASSERT_FLOAT_EQ(map.log_odds[i], static_cast<float>(grid.at(c)) * 1e-3F);
    ASSERT_EQ(occupancy.occupancy[i] == 1, grid.at(c) > 0);
    ASSERT_EQ(occupancy.observable[i] == 1, grid.at(c) != 0);
  });
}

TEST(MapConversion, OneCellKeepsItsSign) {
  LogOddsGrid grid(box_frame({0, 0, 0}, {1, 1, 1}, 1));
  grid.apply(one_mark({0, 0, 0}, Mark::occupied), step);
  EXPECT_FLOAT_EQ(dense_map(grid).log_odds[0], 2.944F);
  EXPECT_EQ(occupancy_of(dense_map(grid)).occupancy[0], 1);
}

TEST(MapConversion, WrongArraysAreRefusedAndInfinityIsTheLimit) {
  LogOddsMap map{box_frame({0, 0, 0}, {1, 1, 1}, 0.5), std::vector<float>(7)};
  EXPECT_THROW(grid_of(map), ConfigError);
  map.log_odds = {1, 2, 3, 4, 5, 6, 7, std::numeric_limits<float>::quiet_NaN()};
  EXPECT_THROW(grid_of(map), DataError);
  map.log_odds[7] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(grid_of(map).at({1, 1, 1}), std::numeric_limits<MilliLogOdds>::max());
}

}  // namespace
}  // namespace ensonify
