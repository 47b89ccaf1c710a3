#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/chain.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/pipe.hpp"
#include "ensonify/scenes/tube.hpp"

/// Pipes, cables and chains against closed forms.
namespace ensonify {
namespace {

using std::numbers::pi;

TEST(Torus, VolumeComesFromBelowToTheClosedForm) {
  const double exact = 2 * pi * pi * 1.5 * 0.16;
  double error = exact;
  for (const int segments : {16, 32, 64, 128}) {
    const double volume = enclosed_volume_m3(make_torus(1.5, 0.4, segments, segments));
    EXPECT_LT(volume, exact);
    EXPECT_LT(exact - volume, 0.3 * error) << "falls with the square of the segments";
    error = exact - volume;
  }
}

// y = a cosh(x / a) between ends at equal height: length 2 a sinh(h / 2a), sag a (cosh(h / 2a) - 1).
TEST(HangingLine, HasTheLengthOfTheCatenary) {
  const double a = 3, h = 8;
  const HangingLine line({0, 0, 1}, {h, 0, 1}, a * (std::cosh(h / 2 / a) - 1));
  EXPECT_NEAR(line.length_m(), 2 * a * std::sinh(h / 2 / a), 1e-9);
  EXPECT_NEAR(line.at(0.5).z(), 1 - a * (std::cosh(h / 2 / a) - 1), 1e-9);
  EXPECT_NEAR(path_length_m(line.points_m(4000)), line.length_m(), 1e-5);
}

RC_GTEST_PROP(HangingLine, MeetsItsEndsAndSagsAsMuchAsAskedFor, ()) {
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 10.0; };
  const Vec3 from(number(-50, 50), number(-50, 50), number(-50, 50));
  const Vec3 to = from + Vec3(number(5, 90), number(-50, 50), number(-90, 90));
  const double sag_m = number(1, 60);
  const HangingLine line(from, to, sag_m);
  RC_ASSERT((line.at(1e-9) - from).norm() < 1e-6);
  RC_ASSERT((line.at(1 - 1e-9) - to).norm() < 1e-6);
  double deepest = 0, step = line.length_m() / 2000;
  const std::vector<Vec3> points = line.points_m(2000);
  const Eigen::Vector2d span = (to - from).head<2>();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = (points[i] - from).head<2>().dot(span) / span.squaredNorm();
    deepest = std::max(deepest, from.z() + along * (to.z() - from.z()) - points[i].z());
    if (i > 0) RC_ASSERT((points[i] - points[i - 1]).norm() <= step * (1 + 1e-9));
  }
  RC_ASSERT(std::abs(deepest - sag_m) < 1e-3 * sag_m);
}

TEST(Chain, LinksMeetFromEndToEnd) {
  const ChainLink link{.length_m = 0.3, .width_m = 0.18, .wire_radius_m = 0.025};
  const Vec3 from(0, 0, 0), to(6, 2, 1.5);
  const HangingLine line(from, to, 1.2);
  const Assembly chain = build_chain(link, line);
  ASSERT_EQ(chain.parts.size(), static_cast<std::size_t>(std::lround(line.length_m() / 0.2)));
  ASSERT_EQ(chain.meshes.size(), 1u);
  const Vec3 head(0.5 * link.pitch_m(), 0, 0);
  Vec3 bearing = from;
  for (const Part& part : chain.parts) {
    EXPECT_LT((part.T_object_part * -head - bearing).norm(), 1e-9);
    bearing = part.T_object_part * head;
  }
  EXPECT_LT((bearing - to).norm(), 1e-9);
  for (std::size_t i = 0; i + 1 < chain.parts.size(); ++i) {
    const Vec3 flat = chain.parts[i].T_object_part.linear().col(2),
               next = chain.parts[i + 1].T_object_part.linear().col(2);
    EXPECT_LT(std::abs(flat.dot(next)), 0.1) << "neighbours stand across each other";
  }
}

TEST(Chain, LinkHasTheVolumeOfItsWire) {
  const ChainLink link{.length_m = 0.3, .width_m = 0.18, .wire_radius_m = 0.025};
  const TriangleMesh mesh = make_chain_link(link);
  // Pappus, for a wire of twelve sides about two straights of 0.12 m and sixteen pieces of a circle.
  const double section = 12 * 0.5 * std::sin(2 * pi / 12) * 0.025 * 0.025;
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  EXPECT_NEAR(enclosed_volume_m3(mesh), section * (2 * 0.12 + 0.065 * 16 * std::sin(2 * pi / 16)), 1e-7);
  EXPECT_NEAR(bounding_box_m(mesh).sizes().x(), 0.3, 1e-6);
  EXPECT_NEAR(bounding_box_m(mesh).sizes().y(), 0.18, 1e-6);
}

TEST(Pipe, HollowPipeHasTheVolumeOfItsWall) {
  const Pipe pipe{.path_m = {{0, 0, 0}, {0, 5, 0}}, .radius_m = 0.3, .wall_m = 0.1, .segments = 64};
  const Assembly assembly = build_pipe(pipe);
  const double polygon = 64 * 0.5 * std::sin(2 * pi / 64);
  EXPECT_EQ(unpaired_edges(assembly.meshes[0]), 0u);
  EXPECT_NEAR(enclosed_volume_m3(assembly.meshes[0]), 5 * polygon * (0.09 - 0.04), 1e-5);
}

TEST(Pipe, BendsKeepTheirRadius) {
  std::size_t too_tight = 9;
  const std::vector<Vec3> path = round_corners({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}}, 1, too_tight);
  EXPECT_EQ(too_tight, 0u);
  EXPECT_NEAR(path_length_m(path), 6 + pi / 2, 0.002);
  for (const Vec3& p : path) {
    const bool on_bend = p.x() > 3 + 1e-9 && p.y() < 1 - 1e-9;
    EXPECT_TRUE(!on_bend || std::abs((p - Vec3(3, 1, 0)).norm() - 1) < 1e-9) << p.transpose();
  }
  round_corners({{0, 0, 0}, {4, 0, 0}, {4, 0.9, 0}}, 1, too_tight);
  EXPECT_EQ(too_tight, 1u);
  round_corners({{0, 0, 0}, {4, 0, 0}, {4, 1.5, 0}, {8, 1.5, 0}}, 1, too_tight);
  EXPECT_EQ(too_tight, 2u) << "the second bend wants what the first has used";
}

TEST(Pipe, MitredBarKeepsItsThickness) {
  const TriangleMesh mesh = make_bar({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}}, 0.2, 64);
  EXPECT_EQ(unpaired_edges(mesh), 0u);
  const Eigen::AlignedBox3d box = bounding_box_m(mesh);
  EXPECT_NEAR(box.max().x(), 3.2, 1e-3);
  EXPECT_NEAR(box.min().y(), -0.2, 1e-3);
  EXPECT_NEAR(box.max().z(), 0.2, 1e-3);
}

TEST(Pipe, FlangesSitAtTheEndsAndEvenlyBetween) {
  Pipe pipe{.path_m = {{0, 0, 0}, {10, 0, 0}}};
  pipe.flange_spacing_m = 2.4;
  pipe.bolts = 6;
  const Assembly assembly = build_pipe(pipe);
  EXPECT_EQ(assembly.parts.size(), 1u + 5 * (1 + 6));
  EXPECT_EQ(assembly.meshes.size(), 3u);
}

}  // namespace
}  // namespace ensonify
