#include "ensonify/sim/voxel_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

using Triangle = std::array<Vec3, 3>;
constexpr std::array<int, 3> box_low = {-1, -1, -1};
constexpr std::array<int, 3> box_size = {16, 16, 16};

/// Does the triangle touch the cube of half side `half` at `centre`? All 13 axes, none left out.
bool touches(const Triangle& t, const Vec3& centre, double half) {
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), (t[1] - t[0]).cross(t[2] - t[0])};
  for (int edge = 0; edge < 3; ++edge) {
    for (int axis = 0; axis < 3; ++axis) axes.push_back((t[(edge + 1) % 3] - t[edge]).cross(Vec3::Unit(axis)));
  }
  for (const Vec3& axis : axes) {
    const double a = axis.dot(t[0] - centre);
    const double b = axis.dot(t[1] - centre);
    const double c = axis.dot(t[2] - centre);
    const double reach = half * axis.cwiseAbs().sum();
    if (std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach) return false;
  }
  return true;
}

BitGrid marked(const Triangle& t) {
  BitGrid surface(box_low, box_size);
  const std::array<std::array<std::uint32_t, 3>, 1> index = {{{0, 1, 2}}};
  mark_surface(t, index, surface);
  return surface;
}

/// Calls check(centre, marked) for every cell but those of the rim.
template <typename Check>
void for_each_cell(const BitGrid& surface, const Check& check) {
  for (int z = 1; z + 1 < box_size[2]; ++z) {
    for (int y = 1; y + 1 < box_size[1]; ++y) {
      for (int x = 1; x + 1 < box_size[0]; ++x) {
        check(Vec3(box_low[0] + x + 0.5, box_low[1] + y + 0.5, box_low[2] + z + 0.5), surface.test(x, y, z));
      }
    }
  }
}

/// Every cell that the triangle touches is marked, none that it misses by more than twice the margin.
void expect_conservative(const Triangle& t) {
  for_each_cell(marked(t), [&](const Vec3& centre, bool is) {
    ASSERT_TRUE(is || !touches(t, centre, 0.5)) << "missed " << centre.transpose();
    ASSERT_TRUE(!is || touches(t, centre, 0.5 + 2.5 * surface_margin_cells)) << "extra " << centre.transpose();
  });
}

/// Points all over the triangle, its edges and corners included, lie in marked cells.
void expect_points_marked(const Triangle& t) {
  const BitGrid surface = marked(t);
  constexpr int steps = 40;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const Vec3 p = t[0] + (t[1] - t[0]) * i / steps + (t[2] - t[0]) * j / steps;
      const int x = static_cast<int>(std::floor(p.x())) - box_low[0];
      const int y = static_cast<int>(std::floor(p.y())) - box_low[1];
      const int z = static_cast<int>(std::floor(p.z())) - box_low[2];
      if (std::min({x, y, z}) < 1 || std::max({x, y, z}) > box_size[0] - 2) continue;
      ASSERT_TRUE(surface.test(x, y, z)) << p.transpose();
    }
  }
}

Vec3 random_point(RandomSequence& random, double low, double high) {
  return {random.uniform(low, high), random.uniform(low, high), random.uniform(low, high)};
}

TEST(VoxelSurface, RandomTrianglesOfAllSizesAreConservative) {
  RandomSequence random(RandomKey::from_seed(1));
  for (int i = 0; i < 120; ++i) {
    const double size = std::pow(10, random.uniform(-2, 2));
    const Vec3 at = random_point(random, 0, 14);
    const Triangle t = {at, at + random_point(random, -size, size), at + random_point(random, -size, size)};
    expect_conservative(t);
    expect_points_marked(t);
  }
}

TEST(VoxelSurface, TrianglesOnCellBordersAndCentresAreConservative) {
  RandomSequence random(RandomKey::from_seed(2));
  for (int i = 0; i < 120; ++i) {
    Triangle t;
    for (Vec3& p : t) p = Vec3(random.below(29), random.below(29), random.below(29)) * 0.5;
    const auto lies_on_a_border = [&](int a) {
      return t[0][a] == t[1][a] && t[0][a] == t[2][a] && t[0][a] == std::round(t[0][a]);
    };
    if (lies_on_a_border(0) || lies_on_a_border(1) || lies_on_a_border(2)) continue;  // the next test's
    expect_conservative(t);
    expect_points_marked(t);
  }
}

/// Vertices off the border by up to 9 tenths of the margin; the normal of every other triangle points down.
TEST(VoxelSurface, FacesOnCellBordersMarkTheLayerBehindThem) {
  RandomSequence random(RandomKey::from_seed(5));
  for (int i = 0; i < 200; ++i) {
    const int axis = i % 3;
    const auto border = static_cast<double>(3 + random.below(9));
    Triangle face;
    for (Vec3& p : face) {
      p = random_point(random, -2, 16);
      p[axis] = border;
    }
    Triangle behind = face;
    const Vec3 n = (face[1] - face[0]).cross(face[2] - face[0]);
    for (Vec3& p : behind) p[axis] -= std::copysign(0.5, n[axis]);
    for (Vec3& p : face) p[axis] += 0.9 * surface_margin_cells * random.uniform(-1, 1);
    for_each_cell(marked(face), [&](const Vec3& centre, bool is) {
      ASSERT_TRUE(is || !touches(behind, centre, 0.5 - 2.5 * surface_margin_cells)) << "missed " << centre.transpose();
      ASSERT_TRUE(!is || touches(behind, centre, 0.5)) << "extra " << centre.transpose();
    });
  }
}

TEST(VoxelSurface, SliversAndDegenerateTrianglesMarkWhatTheyTouch) {
  RandomSequence random(RandomKey::from_seed(3));
  for (int i = 0; i < 120; ++i) {
    const Vec3 a = random_point(random, -5, 19);
    const Vec3 b = random_point(random, -5, 19);
    const double off = i % 3 == 0 ? 0 : std::pow(10, random.uniform(-17, -3));
    const Vec3 c = a + (b - a) * random.uniform(0, 1) + off * random_point(random, -1, 1);
    expect_points_marked({a, c, b});
    expect_points_marked({a, a, b});
    expect_points_marked({a, a, a});
    expect_conservative({a, c, b});
  }
}

TEST(VoxelSurface, HugeTrianglesAreMarkedWhereTheyCrossTheBox) {
  RandomSequence random(RandomKey::from_seed(4));
  for (int i = 0; i < 100; ++i) {
    const Vec3 through = random_point(random, 2, 12);
    const Vec3 u = random_point(random, -1e5, 1e5);
    const Vec3 v = random_point(random, -1e5, 1e5);
    const Triangle t = {through + u, through + v, through - u - v};
    const BitGrid surface = marked(t);
    EXPECT_TRUE(surface.test(static_cast<int>(through.x()) + 1, static_cast<int>(through.y()) + 1,
                             static_cast<int>(through.z()) + 1));
    EXPECT_LT(surface.count(), 14u * 14 * 14 / 3);
  }
}

}  // namespace
}  // namespace ensonify
