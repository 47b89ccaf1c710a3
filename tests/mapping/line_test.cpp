// Lines of cells against their definitions, cell by cell.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <set>
#include <vector>

#include "ensonify/core/random.hpp"
#include "ensonify/mapping/exact_line.hpp"

namespace ensonify {
namespace {

/// A box of 20 x 20 x 20 cells whose corner is not 0, in memory of any order.
const StridedBox box = {{{-5, -4, -3}, {15, 16, 17}}, {-5, -4, -3}, {1, 20, 400}};

Cell cell_at(const StridedBox& in, std::ptrdiff_t offset) {
  Cell c{};
  for (int a = 2; a >= 0; --a) {
    c[a] = in.first[a] + static_cast<int>(offset / in.stride[a]);
    offset %= in.stride[a];
  }
  return c;
}

std::vector<Cell> bresenham(const Cell& from, const Cell& to, const StridedBox& in = box,
                            LineEnd end = LineEnd::included) {
  std::vector<Cell> cells;
  walk_bresenham(from, to, end, in, [&](std::ptrdiff_t offset) { cells.push_back(cell_at(in, offset)); });
  return cells;
}

std::vector<Cell> exact(const Vec3& from, const Vec3& to, const StridedBox& in = box, LineEnd end = LineEnd::included) {
  std::vector<Cell> cells;
  walk_exact(from, to, end, in, [&](std::ptrdiff_t offset) { cells.push_back(cell_at(in, offset)); });
  return cells;
}

/// By rounding each coordinate of each step, halves up.
std::vector<Cell> rounded_line(const Cell& from, const Cell& to) {
  int steps = 0;
  for (int a = 0; a < 3; ++a) steps = std::max(steps, std::abs(to[a] - from[a]));
  std::vector<Cell> cells;
  for (int i = 0; i <= steps; ++i) {
    Cell c = from;
    for (int a = 0; a < 3 && steps > 0; ++a) {
      const int twice = 2 * from[a] * steps + 2 * i * (to[a] - from[a]) + steps;  // 2 steps (coordinate + 1/2)
      c[a] = static_cast<int>(std::floor(static_cast<double>(twice) / (2.0 * steps)));
    }
    if (box.box.contains(c)) cells.push_back(c);
  }
  return cells;
}

/// Length of the line inside a cell, in parts of the line; negative: it passes beside.
double share_inside(const Vec3& from, const Vec3& to, const Cell& c) {
  double enter = 0;
  double leave = 1;
  for (int a = 0; a < 3; ++a) {
    const double d = to[a] - from[a];
    if (d == 0) {
      if (std::floor(from[a]) != c[a]) return -1;
      continue;
    }
    const double t0 = (c[a] - from[a]) / d;
    const double t1 = (c[a] + 1 - from[a]) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return leave - enter;
}

Cell any_cell(int reach) {
  return {*rc::gen::inRange(-reach, reach), *rc::gen::inRange(-reach, reach), *rc::gen::inRange(-reach, reach)};
}

TEST(Bresenham, NearestCellsOfEveryLineInsideTheBoxAndNoOther) {
  EXPECT_TRUE(rc::check("cells as rounded", [] {
    const Cell from = any_cell(60);
    const Cell to = any_cell(60);
    RC_ASSERT(bresenham(from, to) == rounded_line(from, to));
  }));
}

TEST(Bresenham, TheLineBackHasTheSameCells) {
  EXPECT_TRUE(rc::check("reversal", [] {
    const Cell from = any_cell(60);
    const Cell to = any_cell(60);
    std::vector<Cell> back = bresenham(to, from);
    std::reverse(back.begin(), back.end());
    RC_ASSERT(bresenham(from, to) == back);
  }));
}

TEST(Bresenham, EndsAndFarEnds) {
  EXPECT_EQ(bresenham({1, 2, 3}, {1, 2, 3}), (std::vector<Cell>{{1, 2, 3}}));
  EXPECT_TRUE(bresenham({1, 2, 3}, {1, 2, 3}, box, LineEnd::excluded).empty());
  EXPECT_EQ(bresenham({1, 2, 3}, {4, 2, 3}, box, LineEnd::excluded),
            (std::vector<Cell>{{1, 2, 3}, {2, 2, 3}, {3, 2, 3}}));
  EXPECT_TRUE(bresenham({-9, 0, 0}, {-9, 9, 9}).empty());
  // Through the box from as far as it may be, without overflow: the diagonal.
  const int far = farthest_cell - 1;
  const std::vector<Cell> diagonal = bresenham({-far, -far, -far}, {far, far, far});
  ASSERT_EQ(diagonal.size(), 18U);
  for (const Cell& c : diagonal) EXPECT_TRUE(c[0] == c[1] && c[1] == c[2]);
}

TEST(ExactLine, EveryCellThatALinePassesThroughAndNoOther) {
  RandomSequence random(RandomKey::from_seed(5));
  for (int i = 0; i < 4000; ++i) {
    const double reach = i % 2 ? 12 : 60;  // half of them with ends far outside
    Vec3 from, to;
    for (int a = 0; a < 3; ++a) {
      from[a] = random.uniform(6 - reach, 6 + reach);
      to[a] = i % 7 == a ? from[a] : random.uniform(6 - reach, 6 + reach);  // along planes of cells, too
    }
    const std::vector<Cell> cells = exact(from, to);
    const std::set<Cell> set(cells.begin(), cells.end());
    ASSERT_EQ(set.size(), cells.size()) << "twice";
    for (int z = -3; z < 17; ++z) {
      for (int y = -4; y < 16; ++y) {
        for (int x = -5; x < 15; ++x) {
          const double share = share_inside(from, to, {x, y, z});
          if (std::abs(share) < 1e-12) continue;
          ASSERT_EQ(set.contains({x, y, z}), share > 0) << i << ": " << x << ' ' << y << ' ' << z << " share " << share;
        }
      }
    }
  }
}

TEST(ExactLine, OneFaceAtATimeFromTheFirstCellToTheLast) {
  EXPECT_TRUE(rc::check("6-connected, also along borders and through corners", [] {
    // Multiples of a half: corners, edges and faces are met all the time.
    Vec3 from, to;
    for (int a = 0; a < 3; ++a) {
      from[a] = 0.5 * *rc::gen::inRange(-6, 28);
      to[a] = 0.5 * *rc::gen::inRange(-6, 28);
    }
    const std::vector<Cell> cells = exact(from, to);
    RC_ASSERT(!cells.empty());
    for (int a = 0; a < 3; ++a) {
      RC_ASSERT(cells.front()[a] == static_cast<int>(std::floor(from[a])));
      RC_ASSERT(cells.back()[a] == static_cast<int>(std::floor(to[a])));
    }
    for (std::size_t i = 1; i < cells.size(); ++i) {
      int moved = 0;
      for (int a = 0; a < 3; ++a) moved += std::abs(cells[i][a] - cells[i - 1][a]);
      RC_ASSERT(moved == 1);
    }
  }));
}

TEST(ExactLine, ClippingKeepsTheCellsInside) {
  const StridedBox wide = {{{-64, -64, -64}, {64, 64, 64}}, {-64, -64, -64}, {1, 128, 128 * 128}};
  EXPECT_TRUE(rc::check("as of the whole line", [&] {
    Vec3 from, to;
    for (int a = 0; a < 3; ++a) {
      from[a] = *rc::gen::inRange(-6000, 6000) / 100.0 + 0.00123;
      to[a] = *rc::gen::inRange(-6000, 6000) / 100.0 + 0.00271;
    }
    std::vector<Cell> inside;
    for (const Cell& c : exact(from, to, wide)) {
      if (box.box.contains(c)) inside.push_back(c);
    }
    RC_ASSERT(exact(from, to) == inside);
  }));
}

TEST(ExactLine, TheLineBackHasTheSameCellsAwayFromEdges) {
  RandomSequence random(RandomKey::from_seed(8));
  for (int i = 0; i < 2000; ++i) {
    const auto point = [&] { return Vec3(random.uniform(-4, 14), random.uniform(-3, 15), random.uniform(-2, 16)); };
    const Vec3 from = point();
    const Vec3 to = point();
    std::vector<Cell> back = exact(to, from);
    std::reverse(back.begin(), back.end());
    ASSERT_EQ(exact(from, to), back);
  }
}

TEST(ExactLine, ZeroLengthAxesAndAnExcludedEnd) {
  EXPECT_EQ(exact({1.5, 2.5, 3.5}, {1.5, 2.5, 3.5}), (std::vector<Cell>{{1, 2, 3}}));
  EXPECT_TRUE(exact({1.5, 2.5, 3.5}, {1.7, 2.5, 3.5}, box, LineEnd::excluded).empty());
  EXPECT_EQ(exact({1.5, 2, 3}, {-0.5, 2, 3}), (std::vector<Cell>{{1, 2, 3}, {0, 2, 3}, {-1, 2, 3}}));
  EXPECT_EQ(exact({1, 2, 3}, {1, 2, 5}, box, LineEnd::excluded), (std::vector<Cell>{{1, 2, 3}, {1, 2, 4}}));
  // From and to the outside; tiny slopes.
  EXPECT_EQ(exact({-1e6, 0.5, 0.5}, {1e6, 0.5, 0.5}).size(), 20U);
  EXPECT_EQ(exact({-1e8, 0.5, 0.5}, {1e8, 0.5 + 1e-9, 0.5 - 1e-12}).size(), 20U);
  EXPECT_TRUE(exact({-9, 0.5, 0.5}, {-8, 99.5, 0.5}).empty());
}

/// On average lines in general direction meet 1.5 times as many cells as the nearest-cell line visits (26-connected
/// against 6-connected), and contain nearly all of those.
TEST(Lines, BresenhamVisitsFewerCells) {
  RandomSequence random(RandomKey::from_seed(2));
  std::size_t few = 0;
  std::size_t many = 0;
  std::size_t common = 0;
  for (int i = 0; i < 2000; ++i) {
    Cell from{}, to{};
    Vec3 a, b;
    for (int k = 0; k < 3; ++k) {
      from[k] = random.below(18) - 3;
      to[k] = random.below(18) - 3;
      a[k] = from[k] + 0.5;
      b[k] = to[k] + 0.5;
    }
    const std::vector<Cell> thin = bresenham(from, to);
    const std::vector<Cell> all = exact(a, b);
    const std::set<Cell> set(all.begin(), all.end());
    few += thin.size();
    many += all.size();
    for (const Cell& c : thin) common += set.contains(c);
  }
  EXPECT_NEAR(static_cast<double>(few) / static_cast<double>(many), 0.6, 0.06);
  EXPECT_GT(static_cast<double>(common) / static_cast<double>(few), 0.95);
}

}  // namespace
}  // namespace ensonify
