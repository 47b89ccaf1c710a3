#include "ensonify/evaluation/map_scores.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/evaluation/map_picture.hpp"
#include "ensonify/evaluation/map_report.hpp"
#include "ensonify/evaluation/map_summary.hpp"

namespace ensonify {
namespace {

constexpr float free_once = -0.201F;
constexpr float occupied_once = 2.944F;

GridFrame frame_of(int nx, int ny, int nz) {
  return {.origin_m = Vec3(-1, 2, -3), .resolution_m = 0.1, .size = {nx, ny, nz}};
}

/// A wall, one cell thick, at x = 6 of 12, all observable before it and none behind; behind it interior.
OccupancyGrid wall() {
  OccupancyGrid grid{frame_of(12, 4, 3), {}, {}};
  grid.occupancy.assign(grid.frame.cells(), 0);
  grid.observable.assign(grid.frame.cells(), 0);
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 12; ++x) {
        grid.occupancy[grid.frame.index(x, y, z)] = x == 6 ? 1 : x > 6 ? 2 : 0;
        grid.observable[grid.frame.index(x, y, z)] = x <= 6;
      }
    }
  }
  return grid;
}

/// Free up to the wall of the map at x = `at`, which is occupied; unknown behind.
LogOddsMap map_of_wall(int at) {
  LogOddsMap map{frame_of(12, 4, 3), {}};
  map.log_odds.assign(map.frame.cells(), 0);
  for (std::size_t i = 0; i < map.log_odds.size(); ++i) {
    const int x = static_cast<int>(i % 12);
    map.log_odds[i] = x < at ? free_once : x == at ? occupied_once : 0;
  }
  return map;
}

LogOddsMap uniform_map(float value) {
  LogOddsMap map{frame_of(12, 4, 3), {}};
  map.log_odds.assign(map.frame.cells(), value);
  return map;
}

TEST(MapScores, APerfectMapHasNoFault) {
  const MapCounts n = count_map(map_of_wall(6), map_truth(wall(), {0, 1}));
  EXPECT_EQ(n.true_free, 72u);
  EXPECT_EQ(n.true_occupied, 12u);
  EXPECT_EQ(n.observable, 84u);
  EXPECT_EQ(n.fpr(), 0);
  EXPECT_EQ(n.fnr(), 0);
  EXPECT_EQ(n.coverage(), 1);
  EXPECT_EQ(n.iou(), 1);
  EXPECT_EQ(n.balanced_accuracy(), 1);
  for (const std::size_t i : {0u, 1u}) EXPECT_EQ(n.f1(i), 1);
  const auto p = [](float value) { return 1 / (1 + std::exp(-static_cast<double>(value))); };
  EXPECT_NEAR(n.brier(), (72 * std::pow(p(free_once), 2) + 12 * std::pow(1 - p(occupied_once), 2)) / 84, 1e-9);
  EXPECT_NEAR(p(free_once), 0.45, 1e-3);
}

TEST(MapScores, ToleranceForgivesAWallOneCellTooNearButNotTwo) {
  const MapTruth truth = map_truth(wall(), {0, 1, 2});
  const MapCounts one = count_map(map_of_wall(5), truth);
  EXPECT_EQ(one.false_occupied, 12u);
  EXPECT_EQ(one.observable_occupied, 12u);
  EXPECT_EQ(one.f1(0), 0);
  EXPECT_EQ(one.f1(1), 1);
  EXPECT_EQ(one.fnr(), 12.0 / 72);
  EXPECT_EQ(one.tolerant_fnr(0), one.fnr());
  EXPECT_EQ(one.tolerant_fnr(1), 0);
  EXPECT_EQ(one.coverage(), 72.0 / 84);
  EXPECT_TRUE(std::isnan(one.fpr())) << "no cell of the wall is known";
  const MapCounts two = count_map(map_of_wall(4), truth);
  EXPECT_EQ(two.f1(1), 0);
  EXPECT_EQ(two.f1(2), 1);
}

TEST(MapScores, AWallMarkedBehindTheTrueOneIsFoundThoughItsCellsAreNotScored) {
  // Free at x = 6, occupied at x = 7, which is interior and not observable.
  const MapCounts n = count_map(map_of_wall(7), map_truth(wall(), {0, 1}));
  EXPECT_EQ(n.fpr(), 1);
  EXPECT_EQ(n.tolerant_fpr(1), 0);
  EXPECT_EQ(n.recall(0), 0);
  EXPECT_EQ(n.recall(1), 1);
  EXPECT_TRUE(std::isnan(n.precision(1))) << "no scored cell is marked";
  EXPECT_EQ(n.f1(1), 0);
  EXPECT_EQ(n.hidden_occupied_known, 12u);
  EXPECT_EQ(n.hidden_false_free, 0u);
}

TEST(MapScores, InteriorCalledFreeIsCountedBesideTheScoredCells) {
  const MapCounts n = count_map(uniform_map(free_once), map_truth(wall(), {0}));
  EXPECT_EQ(n.fpr(), 1);
  EXPECT_EQ(n.fnr(), 0);
  EXPECT_EQ(n.fp_share(), 12.0 / 84);
  EXPECT_EQ(n.hidden_false_free, 60u);
  EXPECT_EQ(n.known(), 84u) << "hidden cells must not enter the rates";
}

TEST(MapScores, AllMarkedOccupiedIsFprZeroAndFnrOne) {
  const MapCounts n = count_map(uniform_map(occupied_once), map_truth(wall(), {0, 1}));
  EXPECT_EQ(n.fpr(), 0);
  EXPECT_EQ(n.fnr(), 1);
  EXPECT_EQ(n.fn_share(), 72.0 / 84);
  EXPECT_EQ(n.recall(0), 1);
  EXPECT_EQ(n.precision(0), 12.0 / 84);
  EXPECT_EQ(n.precision(1), 24.0 / 84);
  EXPECT_EQ(n.tolerant_fnr(1), 60.0 / 72);
  EXPECT_EQ(n.iou(), 12.0 / 84);
}

TEST(MapScores, NothingMarkedIsNoNumberAndNotZero) {
  const MapCounts n = count_map(uniform_map(0), map_truth(wall(), {0}));
  EXPECT_TRUE(std::isnan(n.fpr()));
  EXPECT_TRUE(std::isnan(n.fnr()));
  EXPECT_TRUE(std::isnan(n.fp_share()));
  EXPECT_TRUE(std::isnan(n.balanced_accuracy()));
  EXPECT_TRUE(std::isnan(n.brier()));
  EXPECT_TRUE(std::isnan(n.precision(0)));
  EXPECT_EQ(n.brier_observable(), 0.25);
  EXPECT_EQ(n.coverage(), 0);
  EXPECT_EQ(n.recall(0), 0);
  EXPECT_EQ(n.f1(0), 0);
  EXPECT_EQ(n.iou(), 0);
  OccupancyGrid water = wall();
  std::ranges::fill(water.occupancy, std::uint8_t{0});
  const MapCounts of_water = count_map(uniform_map(0), map_truth(water, {0}));
  EXPECT_TRUE(std::isnan(of_water.recall(0)));
  EXPECT_TRUE(std::isnan(of_water.f1(0)));
  std::ranges::fill(water.observable, std::uint8_t{0});
  EXPECT_TRUE(std::isnan(count_map(uniform_map(0), map_truth(water, {0})).coverage()));
}

/// Maps and truths without any order: parts put together are the whole, and "near" is what its definition says.
TEST(MapScores, PartsWithAMarginAddUpAndNearIsAsDefined) {
  OccupancyGrid grid{frame_of(19, 13, 11), {}, {}};
  LogOddsMap map{grid.frame, {}};
  const RandomKey key = RandomKey::from_seed(3);
  for (std::size_t i = 0; i < grid.frame.cells(); ++i) {
    grid.occupancy.push_back(uniform_at(key, i) < 0.02 ? 1 : 0);
    grid.observable.push_back(uniform_at(key, i + 10'000) < 0.7);
    const double u = uniform_at(key, i + 20'000);
    map.log_odds.push_back(u < 0.03 ? 1.5F : u < 0.8 ? -0.4F : 0.0F);
  }
  const int k = 2;
  const MapTruth truth = map_truth(grid, {0, k});
  const MapCounts whole = count_map(map, truth);

  std::uint64_t right = 0;
  std::uint64_t found = 0;
  const auto any_near = [&](int x, int y, int z, const auto& is) {
    for (int c = -k; c <= k; ++c)
      for (int b = -k; b <= k; ++b)
        for (int a = -k; a <= k; ++a)
          if (grid.frame.contains(x + a, y + b, z + c) && is(grid.frame.index(x + a, y + b, z + c))) return true;
    return false;
  };
  for (int z = 0; z < 11; ++z) {
    for (int y = 0; y < 13; ++y) {
      for (int x = 0; x < 19; ++x) {
        const std::size_t i = grid.frame.index(x, y, z);
        if (grid.observable[i] == 0) continue;
        right += map.log_odds[i] > 0 && any_near(x, y, z, [&](std::size_t c) { return grid.occupancy[c] != 0; });
        found += grid.occupancy[i] != 0 && any_near(x, y, z, [&](std::size_t c) { return map.log_odds[c] > 0; });
      }
    }
  }
  EXPECT_EQ(whole.tolerant[1].right, right);
  EXPECT_EQ(whole.tolerant[1].found, found);

  MapCounts sum;
  for (int begin = 0; begin < 19; begin += 7) {
    const int low = std::max(begin - k, 0);
    const int high = std::min(begin + 7 + k, 19);
    LogOddsMap part{{grid.frame.origin_m + Vec3(0.1 * low, 0, 0), 0.1, {high - low, 13, 11}}, {}};
    for (int z = 0; z < 11; ++z) {
      for (int y = 0; y < 13; ++y) {
        for (int x = low; x < high; ++x) part.log_odds.push_back(map.log_odds[grid.frame.index(x, y, z)]);
      }
    }
    sum += count_map(part, truth, {{begin - low, 0, 0}, {std::min(begin + 7, 19) - low, 13, 11}});
  }
  EXPECT_EQ(sum.true_free, whole.true_free);
  EXPECT_EQ(sum.false_free, whole.false_free);
  EXPECT_EQ(sum.observable, whole.observable);
  EXPECT_EQ(sum.hidden_false_free, whole.hidden_false_free);
  EXPECT_EQ(sum.squared_error, whole.squared_error);
  EXPECT_EQ(sum.tolerant[1].right, right);
  EXPECT_EQ(sum.tolerant[1].found, found);
  EXPECT_EQ(sum.tolerant[1].false_free, whole.tolerant[1].false_free);
  EXPECT_EQ(sum.tolerant[1].false_occupied, whole.tolerant[1].false_occupied);
}

TEST(MapScores, WhatDoesNotFitIsRefused) {
  OccupancyGrid blind = wall();
  blind.observable.clear();
  EXPECT_THROW(map_truth(blind, {0}), ConfigError);
  EXPECT_THROW(map_truth(wall(), {1, 1}), ConfigError);
  EXPECT_THROW(map_truth(wall(), {-1}), ConfigError);
  const MapTruth truth = map_truth(wall(), {0});
  LogOddsMap shifted = uniform_map(0);
  shifted.frame.origin_m.x() += 0.05;
  EXPECT_THROW(count_map(shifted, truth), ConfigError);
  LogOddsMap beyond = uniform_map(0);
  beyond.frame.origin_m.x() += 0.1;
  EXPECT_THROW(count_map(beyond, truth), ConfigError);
}

/// 100 free and 100 occupied cells, all known.
MapCounts rates(int false_free, int false_occupied) {
  MapCounts n;
  n.false_free = static_cast<std::uint64_t>(false_free);
  n.true_occupied = static_cast<std::uint64_t>(100 - false_free);
  n.false_occupied = static_cast<std::uint64_t>(false_occupied);
  n.true_free = static_cast<std::uint64_t>(100 - false_occupied);
  n.observable = 200;
  n.observable_occupied = 100;
  n.tolerant = {{n.true_occupied, n.true_occupied, n.false_free, n.false_occupied}};
  return n;
}

TEST(MapScores, FnrAtEqualFprIsInterpolatedAlongTheCurve) {
  const std::vector<MapCounts> curve{rates(0, 100), rates(2, 60), rates(6, 20), rates(30, 10)};
  EXPECT_DOUBLE_EQ(fnr_at_fpr(curve, 0.00), 1.00);
  EXPECT_DOUBLE_EQ(fnr_at_fpr(curve, 0.01), 0.80);
  EXPECT_DOUBLE_EQ(fnr_at_fpr(curve, 0.04), 0.40);
  EXPECT_NEAR(fnr_at_fpr(curve, 0.18), 0.15, 1e-12);
  EXPECT_DOUBLE_EQ(fnr_at_fpr(curve, 0.90), 0.10) << "the curve ends before: its best is what can be had";
  EXPECT_TRUE(std::isnan(fnr_at_fpr(std::span(curve).subspan(1), 0.01)));
  EXPECT_TRUE(std::isnan(fnr_at_fpr(std::vector<MapCounts>(3), 0.5)));
}

MapReport example_report() {
  MapReport report{"set", "hash", "test", {0, 1, 2}, {0}, {0.05}, {}};
  report.curves.push_back({"a", "raw", "points", "true", 5, {rates(0, 100), rates(10, 20), rates(40, 5)}});
  report.curves.push_back({"b", "raw", "points", "true", 7, {rates(0, 100), rates(30, 20), rates(60, 5)}});
  report.curves.push_back({"a", "raw", "points", "drifted", 5, {rates(0, 100), rates(30, 40), rates(60, 35)}});
  for (MapCurve& curve : report.curves) {
    MapCounts empty;
    empty.tolerant.resize(1);
    empty.observable = 200;
    empty.observable_occupied = 100;
    if (curve.poses == "drifted") curve.at[0] = empty;
  }
  return report;
}

double named(const std::vector<std::pair<std::string, double>>& summary, const std::string& name) {
  for (const auto& [key, value] : summary) {
    if (key == name) return value;
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(MapReport, ScenesArePooledAndDriftIsTheLossAtTheTrueBestThreshold) {
  MapReport report = example_report();
  add_pooled_curves(report);
  ASSERT_EQ(report.curves.size(), 5u);
  const MapCurve& all = report.curves[3];
  EXPECT_EQ(all.scene, "all");
  EXPECT_EQ(all.frames, 12);
  EXPECT_EQ(all.at[1].fpr(), 0.2);
  EXPECT_EQ(report.curves[0].best(0), 1u);
  const auto drifted = summary_of(report, report.curves[2]);
  EXPECT_NEAR(named(drifted, "loss_balanced_accuracy"), 0.85 - 0.65, 1e-12);
  EXPECT_TRUE(std::isnan(named(summary_of(report, report.curves[0]), "loss_balanced_accuracy")));
}

TEST(MapReport, ZeroOverZeroIsEmptyInCsvAndNullInJson) {
  const MapReport report = example_report();
  const std::string csv = map_scores_csv(report);
  EXPECT_THAT(csv, testing::StartsWith("scene,filter,model,poses,threshold,tp,fp,tn,fn,observable,"));
  EXPECT_THAT(csv, testing::HasSubstr("a,raw,points,drifted,0,0,0,0,0,200,100,0,0,,,,,0,,0,,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 3);
  const auto json = nlohmann::json::parse(map_scores_json(report));
  EXPECT_TRUE(json["curves"][2]["over_threshold"]["fpr"][0].is_null());
  EXPECT_EQ(json["curves"][0]["over_threshold"]["fpr"][1], 0.1);
  EXPECT_EQ(json["curves"][0]["counts"]["fp"][1], 10);
  EXPECT_TRUE(json["curves"][0]["summary"]["loss_f1_k0"].is_null());
  EXPECT_EQ(map_plots(report, "a", "true").plots.size(), 4u);
}

TEST(MapPicture, NorthIsUpAndWhatIsNotScoredIsDim) {
  LogOddsMap map{frame_of(3, 2, 2), std::vector<float>(12, 0)};
  map.log_odds[map.frame.index(2, 1, 0)] = 1;
  map.log_odds[map.frame.index(0, 0, 1)] = 1;
  map.log_odds[map.frame.index(0, 0, 0)] = -1;
  std::vector<std::uint8_t> scored(12, 1);
  scored[map.frame.index(0, 0, 1)] = 0;
  const auto pixels = [&](MapSide side) {
    const auto picture = seen_from_above(map, scored, side);
    return std::vector<int>(picture.pixels().begin(), picture.pixels().end());
  };
  EXPECT_THAT(pixels(MapSide::occupied), testing::ElementsAre(0, 0, 255, 90, 0, 0));
  EXPECT_THAT(pixels(MapSide::free), testing::ElementsAre(0, 0, 0, 255, 0, 0));
}

}  // namespace
}  // namespace ensonify
