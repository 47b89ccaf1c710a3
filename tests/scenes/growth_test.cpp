#include "ensonify/scenes/growth.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/pile_row.hpp"

namespace ensonify {
namespace {

const RandomKey key = RandomKey::from_seed(4);

TEST(Growth, WithoutThicknessOrCoverageNothingChanges) {
  const Assembly piles = build_pile_row({.piles = 3}, key);
  for (const Growth& none : {Growth{.thickness_m = 0}, Growth{.coverage = 0}}) {
    const Assembly same = overgrow(piles, none, key);
    ASSERT_EQ(same.parts.size(), piles.parts.size());
    ASSERT_EQ(same.meshes.size(), 1u);
    EXPECT_EQ(same.meshes[0].vertices_m, piles.meshes[0].vertices_m);
  }
}

TEST(Growth, SplittingKeepsTheShape) {
  const TriangleMesh box = make_box({1, 2, 3});
  const TriangleMesh fine = split_long_edges(box, 0.2, 1'000'000);
  EXPECT_EQ(unpaired_edges(fine), 0u);
  EXPECT_NEAR(enclosed_volume_m3(fine), 6, 1e-5);
  for (const auto& [a, b, c] : fine.triangles) {
    const auto& v = fine.vertices_m;
    ASSERT_LE(std::max({(v[a] - v[b]).norm(), (v[b] - v[c]).norm(), (v[c] - v[a]).norm()}), 0.2f * 1.5f);
  }
}

TEST(Growth, ThinTrianglesAreNotCutIntoThinnerOnesWithoutEnd) {
  const TriangleMesh pile = make_cylinder(0.3, 8, 96);
  const TriangleMesh fine = split_long_edges(pile, 0.05, 1'000'000);
  EXPECT_EQ(unpaired_edges(fine), 0u);
  EXPECT_NEAR(enclosed_volume_m3(fine), enclosed_volume_m3(pile), 1e-4);
  EXPECT_LT(fine.triangles.size(), 2 * 2u * 96 * 160 + 4000) << "two a cell of the grid around and along";
}

RC_GTEST_PROP(Growth, StaysClosedAndWithinItsThickness, ()) {
  const RandomKey any = RandomKey::from_seed(*rc::gen::arbitrary<std::uint64_t>());
  const Growth growth{.thickness_m = 0.05, .patch_m = 0.3, .coverage = *rc::gen::inRange(1, 11) / 10.0};
  const TriangleMesh ball = overgrow(make_sphere(1, 3), growth, any, 1'000'000);
  RC_ASSERT(unpaired_edges(ball) == 0u);
  const double flattest = 0.99;  // of the facets of the icosphere
  for (const Eigen::Vector3f& v : ball.vertices_m) {
    RC_ASSERT(v.norm() <= 1.05 + 1e-5);
    RC_ASSERT(v.norm() >= flattest);
  }
}

TEST(Growth, CoversAboutTheShareAskedFor) {
  for (const double coverage : {0.2, 0.5, 0.8}) {
    const TriangleMesh plate = make_box({20, 20, 1});
    const TriangleMesh grown =
        overgrow(plate, {.thickness_m = 0.1, .patch_m = 0.6, .coverage = coverage}, key, 1'000'000);
    double top = 0, raised = 0;
    for (const Eigen::Vector3f& v : grown.vertices_m) {
      if (v.z() < 0.49f || v.cwiseAbs().head<2>().maxCoeff() > 9.9f) continue;
      ++top;
      raised += v.z() > 0.5001f;
    }
    EXPECT_NEAR(raised / top, coverage, 0.08);
  }
}

TEST(Growth, MakesEveryInstanceDifferent) {
  const Assembly piles = overgrow(build_pile_row({.piles = 2}, key), {.thickness_m = 0.05, .patch_m = 0.3}, key);
  ASSERT_EQ(piles.meshes.size(), 2u);
  const Eigen::Vector3f step(2, 0, 0);
  bool same = true;
  for (std::size_t i = 0; i < piles.meshes[0].vertices_m.size(); ++i) {
    same &= (piles.meshes[0].vertices_m[i] + step - piles.meshes[1].vertices_m[i]).norm() < 1e-4f;
  }
  EXPECT_FALSE(same);
}

TEST(Growth, RefusesToFillTheMemory) {
  const Assembly large = assembly_of(make_box({100, 100, 10}));
  EXPECT_THROW(overgrow(large, {.thickness_m = 0.01, .patch_m = 0.02}, key), GrowthTooFine);
}

}  // namespace
}  // namespace ensonify
