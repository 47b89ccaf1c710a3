// The parts of the closed loop on slices drawn here: no scene, no sonar, an ideal sensor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/generators/explore_gate.hpp"
#include "ensonify/generators/explore_plugin.hpp"

namespace ensonify {
namespace {

constexpr double cell_m = 0.1;

/// '.' free, '#' occupied, '?' unknown; the first row is the north-most.
Slice drawn(const std::vector<std::string>& rows) {
  Slice slice{{Vec3::Zero(), cell_m, {static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), 1}}, {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    for (const char c : *row) {
      slice.columns.push_back(c == '.' ? ColumnState::free : c == '#' ? ColumnState::occupied : ColumnState::unknown);
    }
  }
  return slice;
}

Slice filled(int nx, int ny, ColumnState state) {
  Slice slice{{Vec3::Zero(), cell_m, {nx, ny, 1}}, {}};
  slice.columns.assign(static_cast<std::size_t>(nx * ny), state);
  return slice;
}

void fill(Slice& slice, int x0, int y0, int x1, int y1, ColumnState state) {
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) slice.columns[slice.index(x, y)] = state;
  }
}

/// Two rooms of 6 x 6 m, joined by a door 1.2 m wide, a post in the eastern one.
Slice two_rooms() {
  Slice slice = filled(130, 64, ColumnState::occupied);
  fill(slice, 2, 2, 62, 62, ColumnState::free);
  fill(slice, 68, 2, 128, 62, ColumnState::free);
  fill(slice, 62, 40, 68, 52, ColumnState::free);
  fill(slice, 95, 30, 99, 34, ColumnState::occupied);
  return slice;
}

SonarView view() { return {radians(65), radians(-65), 0.4, 5}; }

/// What an ideal sonar adds to the map.
void look(const Slice& truth, const PlanarPose& at, Slice& map) {
  const SonarView sonar = view();
  for (double azimuth = sonar.starboard_rad; azimuth <= sonar.port_rad; azimuth += radians(0.2)) {
    for (double r = 0; r < sonar.range_max_m; r += 0.25 * cell_m) {
      const int ix = truth.ix_of(at.x_m + r * std::cos(at.yaw_rad + azimuth));
      const int iy = truth.iy_of(at.y_m + r * std::sin(at.yaw_rad + azimuth));
      if (!truth.contains(ix, iy)) break;
      if (r >= sonar.nearest_m) map.columns[map.index(ix, iy)] = truth.at(ix, iy);
      if (truth.at(ix, iy) == ColumnState::occupied) break;
    }
  }
}

PlannerSettings planner(const Slice& slice) {
  PlannerSettings settings;
  settings.view = view();
  settings.area.assign(slice.columns.size(), 1);
  settings.interest.assign(slice.columns.size(), 1);
  return settings;
}

struct Tour {
  std::vector<PlanarPose> poses;
  Slice map;
  bool ended = false;
  int not_known_free = 0;  ///< steps that brought the body over columns that were not known to be free
};

Tour tour(const Slice& truth, const PlanarPose& start, int steps) {
  const PlannerSettings settings = planner(truth);
  Tour t{{start}, filled(truth.frame.size[0], truth.frame.size[1], ColumnState::unknown)};
  PlannerMemory memory = memory_at(t.map, start, 0.7);
  for (int i = 0; i < steps; ++i) {
    look(truth, t.poses.back(), t.map);
    const auto next = plan_step(settings, t.map, t.poses.back(), memory);
    if (!next) {
      t.ended = true;
      break;
    }
    for (int iy = 0; iy < truth.frame.size[1]; ++iy) {
      for (int ix = 0; ix < truth.frame.size[0]; ++ix) {
        if (distance_to_column_m(truth, ix, iy, next->x_m, next->y_m) > settings.radius_m) continue;
        const bool known = t.map.at(ix, iy) == ColumnState::free || memory.body[t.map.index(ix, iy)] != 0;
        t.not_known_free += known ? 0 : 1;
      }
    }
    t.poses.push_back(*next);
  }
  return t;
}

TEST(ExplorePlanner, FindsTheOtherRoomThroughItsDoor) {
  const Slice truth = two_rooms();
  const Tour t = tour(truth, {1.5, 1.5, 0}, 400);
  EXPECT_TRUE(t.ended) << "it should see that nothing is left";
  const ReachableSlice all = reachable_slice(truth, ColumnMask(truth.columns.size(), 1), {1.5, 1.5, 0}, 0.3, 5);
  const ExploreScores scores = score_slice(t.map, all);
  EXPECT_GT(scores.coverage, 0.98);
  EXPECT_GT(scores.boundary_found, 0.9);
  EXPECT_EQ(scores.fpr, 0);
  EXPECT_EQ(scores.fnr, 0);
}

TEST(ExplorePlanner, KeepsClearAndWithinColumnsKnownToBeFree) {
  const Slice truth = two_rooms();
  const Tour t = tour(truth, {1.5, 1.5, 0}, 400);
  EXPECT_EQ(t.not_known_free, 0);
  for (std::size_t i = 1; i < t.poses.size(); ++i) {
    EXPECT_GE(clearance_m(truth, t.poses[i - 1], t.poses[i], 2), 0.3) << i;
  }
}

TEST(ExplorePlanner, KeepsTheLimitsOfMotion) {
  const Tour t = tour(two_rooms(), {1.5, 1.5, 2}, 200);
  const MotionLimits limits;
  for (std::size_t i = 1; i < t.poses.size(); ++i) {
    const PlanarPose &a = t.poses[i - 1], &b = t.poses[i];
    EXPECT_LE(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m), limits.step_m() + 1e-9) << i;
    EXPECT_LE(std::abs(turn_between(a.yaw_rad, b.yaw_rad)), limits.step_rad() + 1e-9) << i;
  }
}

TEST(ExplorePlanner, DoesNotDependOnTheNumberOfThreads) {
  const auto run = [](std::size_t threads) {
    const tbb::global_control only(tbb::global_control::max_allowed_parallelism, threads);
    return tour(two_rooms(), {1.5, 1.5, 0}, 120).poses;
  };
  const auto one = run(1);
  const auto two = run(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].x_m, two[i].x_m);
    EXPECT_EQ(one[i].y_m, two[i].y_m);
    EXPECT_EQ(one[i].yaw_rad, two[i].yaw_rad);
  }
}

TEST(ExplorePlanner, TurnsToTheUnknownWhereItCanNotGo) {
  // Known all around but in the west, and no room to move.
  Slice map = filled(80, 80, ColumnState::free);
  fill(map, 0, 0, 20, 80, ColumnState::unknown);
  PlannerSettings settings = planner(map);
  settings.area.assign(map.columns.size(), 0);
  PlannerMemory memory = memory_at(map, {4, 4, 0}, 0.7);
  const auto next = plan_step(settings, map, {4, 4, 0}, memory);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->x_m, 4);
  EXPECT_EQ(next->y_m, 4);
  EXPECT_NEAR(std::abs(next->yaw_rad), settings.limits.step_rad(), 1e-9);
}

TEST(ExplorePlanner, EndsWhereAllIsKnown) {
  const Slice map = filled(60, 60, ColumnState::free);
  PlannerMemory memory = memory_at(map, {3, 3, 0}, 0.7);
  EXPECT_FALSE(plan_step(planner(map), map, {3, 3, 0}, memory));
}

TEST(ExplorePlanner, GivesUpOnColumnsThatManyLooksDoNotTellOf) {
  // A pane: what is behind stays unknown whatever is looked at.
  Slice map = filled(60, 60, ColumnState::free);
  fill(map, 50, 0, 60, 60, ColumnState::unknown);
  PlannerMemory memory = memory_at(map, {2, 3, 0}, 0.7);
  PlanarPose at{2, 3, 0};
  int steps = 0;
  for (; steps < 200; ++steps) {
    const auto next = plan_step(planner(map), map, at, memory);
    if (!next) break;
    at = *next;
  }
  EXPECT_LT(steps, 200);
  EXPECT_GT(steps, 3);
}

TEST(ExploreWays, KeepToAllowedColumnsAndAreShortest) {
  const Slice slice = drawn({"......", "####..", "......"});
  ColumnMask allowed(slice.columns.size());
  for (std::size_t i = 0; i < allowed.size(); ++i) allowed[i] = slice.columns[i] == ColumnState::free ? 1 : 0;
  const Ways ways = shortest_ways(slice, allowed, 0, 0);
  // East along the south row, north, west along the north row; no corner of the wall is cut.
  EXPECT_NEAR(ways.length_m[slice.index(0, 2)], cell_m * (4 + 2 + 4), 1e-12);
  for (const std::size_t column : way_to(ways, slice.index(0, 2))) EXPECT_EQ(allowed[column], 1);
  EXPECT_FALSE(ways.reaches(slice.index(1, 1)));
  EXPECT_TRUE(way_to(ways, slice.index(1, 1)).empty());
}

TEST(ExploreSlice, RoomIsTheDistanceFromAllThatIsNotFree) {
  RandomSequence random(RandomKey::from_seed(4));
  for (int trial = 0; trial < 20; ++trial) {
    Slice slice = filled(23, 17, ColumnState::free);
    for (int i = 0; i < 6; ++i) {
      slice.columns[static_cast<std::size_t>(random.below(23 * 17))] =
          random.below(2) == 0 ? ColumnState::occupied : ColumnState::unknown;
    }
    const double clearance = random.uniform(0.05, 0.5);
    const ColumnMask room = columns_with_room(slice, clearance);
    for (int iy = 0; iy < 17; ++iy) {
      for (int ix = 0; ix < 23; ++ix) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int y = -8; y < 25; ++y) {
          for (int x = -8; x < 31; ++x) {
            if (slice.at(x, y) == ColumnState::free) continue;
            nearest = std::min(nearest, distance_to_column_m(slice, x, y, slice.x_m(ix), slice.y_m(iy)));
          }
        }
        if (std::abs(nearest - clearance) < 1e-9) continue;
        EXPECT_EQ(room[slice.index(ix, iy)] != 0, nearest >= clearance && slice.at(ix, iy) == ColumnState::free);
      }
    }
  }
}

TEST(ExploreSlice, AColumnIsFreeOnlyWhereAllItsCellsAre) {
  LogOddsGrid grid({Vec3::Zero(), cell_m, {4, 1, 2}});
  grid.set({0, 0, 0}, -5), grid.set({0, 0, 1}, -5);
  grid.set({1, 0, 0}, -5);
  grid.set({2, 0, 0}, -5), grid.set({2, 0, 1}, 5);
  EXPECT_THAT(slice_of(grid).columns, testing::ElementsAre(ColumnState::free, ColumnState::unknown,
                                                           ColumnState::occupied, ColumnState::unknown));
}

TEST(ExploreSlice, ASlabHoldsTheLayersThatTheVehicleTouches) {
  const GridFrame whole{{0, 0, -3}, 0.1, {5, 5, 30}};
  const GridFrame slab = slab_of(whole, -1.75, 0.3);
  EXPECT_NEAR(slab.origin_m.z(), -1.9, 1e-12);
  EXPECT_EQ(slab.size[2], 3);
  EXPECT_EQ(slab_of(whole, -1.75, 0).size[2], 1);
  EXPECT_THROW(slab_of(whole, -0.1, 0.3), ConfigError);
}

TEST(ExploreScores, ReachableIsWhereTheBodyGetsAndTheBoundaryWhatIsSeenFromThere) {
  // A room of 2 x 2 m, and one beside it without a door.
  Slice truth = filled(50, 24, ColumnState::occupied);
  fill(truth, 2, 2, 22, 22, ColumnState::free);
  fill(truth, 26, 2, 46, 22, ColumnState::free);
  const ReachableSlice r = reachable_slice(truth, ColumnMask(truth.columns.size(), 1), {1.2, 1.2, 0}, 0.3, 5);
  // Four walls, corners perhaps (rays that graze the walls beside), nothing of the other room.
  EXPECT_GE(std::ranges::count(r.boundary, 1), 80);
  EXPECT_LE(std::ranges::count(r.boundary, 1), 84);
  // The square less five cells in each corner, which a disc of three cells can not reach.
  EXPECT_EQ(std::ranges::count(r.free, 1), 400 - 4 * 5);
  for (std::size_t i = 0; i < r.free.size(); ++i) {
    EXPECT_TRUE(r.free[i] == 0 || truth.columns[i] == ColumnState::free);
  }
  const ReachableSlice none = reachable_slice(truth, ColumnMask(truth.columns.size(), 1), {0.4, 0.4, 0}, 0.3, 5);
  EXPECT_EQ(std::ranges::count(none.free, 1), 0) << "the start has no room";
}

TEST(ExploreScores, CountWhatTheMapSays) {
  const ReachableSlice reachable{{1, 1, 1, 1, 0, 0, 0}, {0, 0, 0, 0, 1, 1, 1}};
  const Slice map = drawn({"..#?.#?"});
  const ExploreScores scores = score_slice(map, reachable);
  EXPECT_DOUBLE_EQ(scores.coverage, 0.5);
  EXPECT_DOUBLE_EQ(scores.fnr, 1.0 / 3);
  EXPECT_DOUBLE_EQ(scores.fpr, 0.5);
  EXPECT_DOUBLE_EQ(scores.boundary_found, 1.0 / 3);
  const ExploreScores unknown = score_slice(drawn({"???????"}), reachable);
  EXPECT_EQ(unknown.coverage, 0);
  EXPECT_TRUE(std::isnan(unknown.fpr) && std::isnan(unknown.fnr));
}

TEST(ExploreScores, ClearanceIsTheLeastAlongTheWay) {
  Slice truth = filled(60, 20, ColumnState::free);
  fill(truth, 30, 10, 31, 11, ColumnState::occupied);
  EXPECT_NEAR(clearance_m(truth, {0.5, 0.5, 0}, {5.5, 0.5, 0}, 2), 0.5, 1e-3);
  EXPECT_EQ(clearance_m(truth, {3.05, 1.05, 0}, {3.05, 1.05, 0}, 2), 0);
  EXPECT_EQ(clearance_m(truth, {0.1, 0.1, 0}, {0.1, 0.1, 0}, 0.5), 0.5);
}

std::vector<ExploreStep> three_steps() {
  std::vector<ExploreStep> steps(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  steps[0].scores = {0.2, 0.1, nan, 0.0};
  steps[1].scores = {0.6, 0.5, 0.02, 0.01};
  steps[2].scores = {0.95, 0.9, 0.04, 0.03};
  steps[0].clearance_m = 1, steps[1].clearance_m = 0.5, steps[2].clearance_m = 0.2;
  return steps;
}

TEST(ExploreGate, JudgesTheStepsThatCount) {
  ExploreGate gate{0.9, 0.05, 0.05, 0.3, {}};
  const auto all = judge(gate, three_steps());
  ASSERT_EQ(all.size(), 4u);
  EXPECT_TRUE(all[0].passed && all[1].passed && all[2].passed);
  EXPECT_FALSE(all[3].passed);
  EXPECT_EQ(all[3].text, "gate: clearance_m 0.2000 >= 0.3: failed");
  EXPECT_FALSE(all_passed(all));
  gate.within_steps = 2;
  const auto two = judge(gate, three_steps());
  EXPECT_FALSE(two[0].passed) << "0.6 so far";
  EXPECT_TRUE(two[3].passed);
}

TEST(ExploreGate, AScoreThatIsNoNumberFails) {
  const ExploreGate gate{{}, 1.0, {}, {}, 1};
  EXPECT_FALSE(judge(gate, three_steps())[0].passed);
}

TEST(ExplorePlugin, AnswersAreRead) {
  const Slice like = filled(3, 3, ColumnState::unknown);
  const GuestReply reply = parse_reply(R"({"pose": [1, 2, 3, 0, 0, 90]})", 0, like, like.frame);
  ASSERT_TRUE(reply.wanted);
  EXPECT_EQ(reply.wanted->y_m, 2);
  EXPECT_NEAR(reply.wanted->yaw_rad, radians(90), 1e-12);
  EXPECT_TRUE(parse_reply(R"({"done": true})", 0, like, like.frame).done);
  EXPECT_FALSE(parse_reply(R"({"done": false})", 0, like, like.frame).done);
}

TEST(ExplorePlugin, NonsenseIsRefused) {
  const Slice like = filled(3, 3, ColumnState::unknown);
  for (const char* line :
       {"", "hello", "[]", "{}", "null", "3", R"({"pose": [1, 2, 3]})", R"({"pose": [1, 2, 3, 0, 0, 1e999]})",
        R"({"pose": [1, 2, 3, 0, 0, "x"]})", R"({"pose": [1e9, 2, 3, 0, 0, 0]})", R"({"position": 1})",
        R"({"done": 1})", R"({"map": 3})", R"({"map": "/nowhere/map.npz"})"}) {
    EXPECT_THROW(parse_reply(line, 7, like, like.frame), DataError) << line;
  }
  const auto said = [&](const std::string& line) -> std::string {
    try {
      parse_reply(line, 7, like, like.frame);
    } catch (const DataError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(said("\x01\xff"), testing::HasSubstr("step 7: is no JSON; it said: \"\\u0001"));
  EXPECT_THAT(said(R"({"map": "/nowhere/map.npz"})"), testing::HasSubstr("step 7: can not read /nowhere/map.npz"));
}

}  // namespace
}  // namespace ensonify
