#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/boulders.hpp"
#include "ensonify/scenes/heightfield.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/pile_row.hpp"
#include "ensonify/scenes/rubble_mound.hpp"

namespace ensonify {
namespace {

using std::numbers::pi;

void expect_closed(const TriangleMesh& mesh, double volume_m3, double relative_error) {
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume_m3(mesh), volume_m3, relative_error * volume_m3);
}

TEST(Shapes, BoxHasItsVolume) { expect_closed(make_box({1, 2, 3}), 6, 1e-6); }

TEST(Shapes, SphereHasItsVolume) {
  expect_closed(make_sphere(0.7, 4), 4.0 / 3.0 * pi * 0.343, 0.01);
  EXPECT_EQ(make_sphere(1, 2).triangles.size(), 320u);
}

TEST(Shapes, CylinderHasTheVolumeOfItsPolygon) {
  const double polygon = 48 * 0.5 * std::sin(2 * pi / 48);  // area of the unit 48-gon
  expect_closed(make_cylinder(0.3, 2), 0.09 * polygon * 2, 1e-5);
}

TEST(Shapes, ConeAndFrustumHaveTheirVolume) {
  const double polygon = 48 * 0.5 * std::sin(2 * pi / 48);
  expect_closed(make_cone(0.5, 0, 1.2), polygon * 0.25 * 1.2 / 3, 1e-5);
  expect_closed(make_cone(0.5, 0.2, 1.2), polygon * (0.25 + 0.1 + 0.04) * 1.2 / 3, 1e-5);
}

TEST(Shapes, PlaneIsSeenFromAbove) {
  const TriangleMesh mesh = make_plane(2, 3);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_m;
    EXPECT_GT((v[b] - v[a]).cross(v[c] - v[a]).z(), 0);
  }
}

TEST(Shapes, HullIsClosedAndFloats) {
  const TriangleMesh mesh = make_hull(8, 2.6, 0.8, 0.9);
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_GT(enclosed_volume_m3(mesh), 0.4 * 8 * 2.6 * 1.7);
  const Eigen::AlignedBox3d box = bounding_box_m(mesh);
  EXPECT_NEAR(box.sizes().x(), 8, 0.3);
  EXPECT_NEAR(box.sizes().y(), 2.6, 0.1);
  EXPECT_NEAR(box.min().z(), -0.8, 0.05);
  EXPECT_NEAR(box.max().z(), 0.9, 1e-6);
}

RC_GTEST_PROP(Shapes, BouldersAreClosedForAnySeed, ()) {
  const RandomKey key = RandomKey::from_seed(*rc::gen::arbitrary<std::uint64_t>());
  const double roughness = *rc::gen::inRange(0, 100) / 100.0;
  const TriangleMesh mesh = make_boulder(0.5, roughness, 0.5, 2, key);
  RC_ASSERT(unpaired_edges(mesh) == 0u);
  RC_ASSERT(enclosed_volume_m3(mesh) > 0.0);
}

Terrain rough_terrain() {
  Terrain terrain;
  terrain.level_m = -5;
  terrain.fractal_rms_m = 0.3;
  terrain.ripple_height_m = 0.05;
  return terrain;
}

HeightGrid rough_grid(std::uint64_t layout, double size_m = 10) {
  const Eigen::AlignedBox2d area(Eigen::Vector2d(0, 0), Eigen::Vector2d(size_m, size_m));
  return sample_terrain(rough_terrain(), RandomKey::from_seed(layout), area, 0.2);
}

TEST(Heightfield, SlabIsClosedAndAsLargeAsItsMeanHeight) {
  const HeightGrid grid = rough_grid(1);
  const TriangleMesh mesh = slab_mesh(grid, 0.5);
  double mean = 0;
  for (const float z : grid.height_m.pixels()) mean += z;
  mean /= static_cast<double>(grid.height_m.size());
  const double bottom = bounding_box_m(mesh).min().z();
  expect_closed(mesh, 100 * (mean - bottom), 0.02);
}

TEST(Heightfield, SheetFacesTheSideAskedFor) {
  const HeightGrid grid = rough_grid(1);
  for (const bool up : {true, false}) {
    const TriangleMesh mesh = sheet_mesh(grid, up);
    const auto& [a, b, c] = mesh.triangles.front();
    const auto& v = mesh.vertices_m;
    EXPECT_EQ((v[b] - v[a]).cross(v[c] - v[a]).z() > 0, up);
  }
}

TEST(Heightfield, SameLayoutSameBitsOtherLayoutOther) {
  EXPECT_EQ(rough_grid(3).height_m, rough_grid(3).height_m);
  EXPECT_FALSE(rough_grid(3).height_m == rough_grid(4).height_m);
}

TEST(Heightfield, FractalHasTheDeviationAskedFor) {
  Terrain terrain;
  terrain.fractal_rms_m = 0.2;
  terrain.fractal_wavelength_m = 4;
  const Eigen::AlignedBox2d area(Eigen::Vector2d(0, 0), Eigen::Vector2d(200, 200));
  const HeightGrid grid = sample_terrain(terrain, RandomKey::from_seed(5), area, 0.71);
  double squares = 0;
  for (const float z : grid.height_m.pixels()) squares += z * z;
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(grid.height_m.size())), 0.2, 0.03);
}

TEST(Heightfield, HeightBetweenNodesIsBilinear) {
  HeightGrid grid{{1, 2}, {0.5, 0.5}, Image2<float>(2, 2)};
  grid.height_m(0, 1) = 1;
  grid.height_m(1, 1) = 3;
  EXPECT_DOUBLE_EQ(grid.at(1.5, 2), 1);
  EXPECT_DOUBLE_EQ(grid.at(1.25, 2.25), 1);
  EXPECT_DOUBLE_EQ(grid.at(99, 99), 3) << "outside: the border";
}

TEST(PileRow, PilesHangFromTheRowAndShareOneMesh) {
  const PileRow row{
      .piles = 4, .spacing_m = 2, .length_m = 6, .radius_m = Uniform{0.1, 0.3}, .tilt_deg = Uniform{0, 4}};
  const Assembly piles = build_pile_row(row, RandomKey::from_seed(1));
  ASSERT_EQ(piles.parts.size(), 4u);
  ASSERT_EQ(piles.meshes.size(), 1u);
  EXPECT_EQ(unpaired_edges(piles.meshes[0]), 0u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::AlignedBox3d box = bounding_box_m(piles.meshes[0], piles.parts[i].T_object_part);
    EXPECT_NEAR(box.max().z(), 0, 0.05);
    EXPECT_NEAR(box.min().z(), -6, 0.05);
    EXPECT_TRUE(box.contains(Vec3(2.0 * static_cast<double>(i), 0, -0.1)));
  }
}

TEST(PileRow, HBeamsAreAsWideAsRoundPiles) {
  const Assembly piles =
      build_pile_row({.length_m = 6, .h_beam = true, .radius_m = Constant{0.2}}, RandomKey::from_seed(1));
  expect_closed(piles.meshes[0], 2 * 2 * 0.13 + 1.74 * 0.16, 1e-5);
  const Eigen::AlignedBox3d box = bounding_box_m(piles.meshes[0], piles.parts[0].T_object_part);
  EXPECT_LT((box.sizes() - Vec3(0.4, 0.4, 6)).norm(), 1e-6);
}

TEST(BoulderScatter, StonesLieApartAndClearOfThePath) {
  BoulderScatter scatter;
  scatter.boulders = 60;
  scatter.where.area_m = Eigen::AlignedBox2d(Eigen::Vector2d(-5, -5), Eigen::Vector2d(5, 5));
  scatter.radius_m = Uniform{0.2, 0.5};
  const ScatterGround ground{[](double, double) { return -3.0; }, {{-5, 0, -2.5}, {5, 0, -2.5}}};
  const Assembly stones = scatter_boulders(scatter, ground, RandomKey::from_seed(2));
  EXPECT_GT(stones.parts.size(), 20u);
  for (const Part& part : stones.parts) {
    const TriangleMesh& mesh = stones.meshes[static_cast<std::size_t>(part.mesh)];
    for (const Eigen::Vector3f& v : mesh.vertices_m) {
      ASSERT_GE(distance_to_path_m(part.T_object_part * v.cast<double>(), ground.path_m),
                scatter.where.path_clearance_m);
    }
    EXPECT_LT(bounding_box_m(mesh, part.T_object_part).min().z(), -3.0 + 0.1) << "a stone hangs above the ground";
  }
}

TEST(RubbleMound, CoreIsClosedAndHasTheVolumeOfItsSection) {
  RubbleMound mound{
      .length_m = 10, .crest_width_m = 2, .height_m = 3, .slope_rad = pi / 4, .one_sided = false, .rocks = {}};
  const ScatterGround ground{[](double, double) { return -3.0; }, {}};
  const Assembly rubble = build_rubble_mound(mound, ground, RandomKey::from_seed(1));
  expect_closed(rubble.meshes.back(), 10 * 3 * 0.5 * (2 + 8), 1e-5);
  EXPECT_DOUBLE_EQ(mound_height_m(mound, 0, 2), -1);
}

TEST(Path, DistanceIsToTheNearestSegment) {
  EXPECT_DOUBLE_EQ(distance_to_path_m({1, 2, 0}, {{0, 0, 0}, {4, 0, 0}}), 2);
  EXPECT_DOUBLE_EQ(distance_to_path_m({7, 4, 0}, {{0, 0, 0}, {4, 0, 0}}), 5);
  EXPECT_TRUE(std::isinf(distance_to_path_m({0, 0, 0}, {})));
}

}  // namespace
}  // namespace ensonify
