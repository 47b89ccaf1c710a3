#include "ensonify/scenes/polygon.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "ensonify/scenes/loft.hpp"
#include "ensonify/scenes/mesh_measure.hpp"

namespace ensonify {
namespace {

const Polygon i_beam{{-1, -1}, {1, -1}, {1, -0.8}, {0.1, -0.8}, {0.1, 0.8},   {1, 0.8},
                     {1, 1},   {-1, 1}, {-1, 0.8}, {-0.1, 0.8}, {-0.1, -0.8}, {-1, -0.8}};
constexpr double i_beam_area = 2 * 2 * 0.2 + 0.2 * 1.6;

TEST(Polygon, AreaIsPositiveCounterClockwise) {
  EXPECT_NEAR(signed_area(i_beam), i_beam_area, 1e-12);
  EXPECT_NEAR(signed_area(Polygon(i_beam.rbegin(), i_beam.rend())), -i_beam_area, 1e-12);
}

TEST(Polygon, TellsSimpleFromCrossing) {
  EXPECT_TRUE(is_simple(i_beam));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 1}, {1, 0}, {0, 1}})) << "a bow tie";
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}})) << "a corner touches an edge";
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}, {1, 0}, {0, 1}})) << "a corner twice";
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {1, 0}, {1, 1}})) << "an edge doubles back";
  EXPECT_FALSE(is_simple({{0, 0}, {1, 0}}));
  EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {2, 0}, {2, 1}})) << "corners in a row are fine";
}

/// A star-shaped outline of random radii: simple, and as concave as it gets.
RC_GTEST_PROP(Polygon, TrianglesFillAnyOutline, ()) {
  const std::vector<int> radii = *rc::gen::container<std::vector<int>>(rc::gen::inRange(5, 100));
  RC_PRE(radii.size() >= 5u);
  Polygon outline;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(radii.size());
    outline.emplace_back(radii[i] * std::cos(angle), radii[i] * std::sin(angle));
  }
  RC_ASSERT(is_simple(outline));
  const auto triangles = triangulate(outline);
  RC_ASSERT(triangles.size() == outline.size() - 2);
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const double one = signed_area({outline[a], outline[b], outline[c]});
    RC_ASSERT(one > 0.0);
    area += one;
  }
  RC_ASSERT(std::abs(area - signed_area(outline)) < 1e-9 * area);
}

TEST(Extrusion, HasTheVolumeOfItsSection) {
  for (const Polygon& outline : {i_beam, Polygon(i_beam.rbegin(), i_beam.rend())}) {
    const TriangleMesh mesh = extrude(outline, -1, 4);
    EXPECT_EQ(unpaired_edges(mesh), 0u);
    EXPECT_NEAR(enclosed_volume_m3(mesh), 5 * i_beam_area, 1e-5);
  }
}

TEST(Lathe, FrustumHasTheVolumeOfItsPolygon) {
  const double polygon = 40 * 0.5 * std::sin(2 * std::numbers::pi / 40);  // area of the unit 40-gon
  const TriangleMesh mesh = turn_profile({{0.5, 0}, {0.2, 1.2}}, 40);
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume_m3(mesh), polygon * (0.25 + 0.1 + 0.04) * 1.2 / 3, 1e-6);
  const TriangleMesh downwards = turn_profile({{0.2, 1.2}, {0.5, 0}}, 40);
  EXPECT_NEAR(enclosed_volume_m3(downwards), enclosed_volume_m3(mesh), 1e-6);
}

TEST(Lathe, RingKeepsItsHoleOpen) {
  const double polygon = 40 * 0.5 * std::sin(2 * std::numbers::pi / 40);
  const TriangleMesh mesh = turn_ring_profile({{0.3, 0}, {0.5, 0}, {0.5, 1}, {0.3, 1}}, 40);
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume_m3(mesh), polygon * (0.25 - 0.09), 1e-6);
}

}  // namespace
}  // namespace ensonify
