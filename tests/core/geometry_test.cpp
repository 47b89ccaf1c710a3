#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "ensonify/core/image2.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {
namespace {

double within(double low, double high) { return low + (high - low) * (*rc::gen::inRange(0, 1'000'001)) / 1e6; }

TEST(Spherical, RoundTrip) {
  EXPECT_TRUE(rc::check([] {
    const Spherical s{within(0.01, 100.0), within(-3.1, 3.1), within(-1.55, 1.55)};
    const Spherical back = to_spherical(from_spherical(s));
    RC_ASSERT(std::abs(back.range_m - s.range_m) < 1e-12 * s.range_m);
    RC_ASSERT(std::abs(back.azimuth_rad - s.azimuth_rad) < 1e-12);
    RC_ASSERT(std::abs(back.elevation_rad - s.elevation_rad) < 1e-12);
  }));
}

// x forward, y left, z up: theta turns to port, phi up.
TEST(Spherical, Axes) {
  EXPECT_TRUE(from_spherical({2.0, 0, 0}).isApprox(Vec3(2, 0, 0)));
  EXPECT_TRUE(from_spherical({2.0, radians(90), 0}).isApprox(Vec3(0, 2, 0), 1e-12));
  EXPECT_TRUE(from_spherical({2.0, 0, radians(90)}).isApprox(Vec3(0, 0, 2), 1e-12));
}

// R = Rz(yaw) Ry(pitch) Rx(roll). Positive pitch turns x (forward) towards -z: nose down. Positive roll turns y (left)
// towards z. Positive yaw turns x towards y.
TEST(PoseConvention, Signs) {
  const auto turned = [](double roll, double pitch, double yaw, const Vec3& v) -> Vec3 {
    return pose_from_xyz_rpy(Vec3::Zero(), radians(roll), radians(pitch), radians(yaw)).linear() * v;
  };
  EXPECT_TRUE(turned(0, 90, 0, {1, 0, 0}).isApprox(Vec3(0, 0, -1), 1e-12));
  EXPECT_TRUE(turned(90, 0, 0, {0, 1, 0}).isApprox(Vec3(0, 0, 1), 1e-12));
  EXPECT_TRUE(turned(0, 0, 90, {1, 0, 0}).isApprox(Vec3(0, 1, 0), 1e-12));
  // Roll first, yaw last: left goes up by roll, and yaw leaves up alone.
  EXPECT_TRUE(turned(90, 0, 90, {0, 1, 0}).isApprox(Vec3(0, 0, 1), 1e-12));
  // Pitch before yaw: forward goes down, whatever the yaw.
  EXPECT_TRUE(turned(0, 90, 57, {1, 0, 0}).isApprox(Vec3(0, 0, -1), 1e-12));
  const Vec3 at = pose_from_xyz_rpy({1, 2, 3}, 0, 0, radians(90)) * Vec3(1, 0, 0);
  EXPECT_TRUE(at.isApprox(Vec3(1, 3, 3), 1e-12));
}

TEST(PoseConvention, AnglesRoundTrip) {
  EXPECT_TRUE(rc::check([] {
    const double roll = within(-3.1, 3.1), pitch = within(-1.5, 1.5), yaw = within(-3.1, 3.1);
    const auto back = roll_pitch_yaw(pose_from_xyz_rpy({1, 2, 3}, roll, pitch, yaw));
    RC_ASSERT(std::abs(back[0] - roll) < 1e-9);
    RC_ASSERT(std::abs(back[1] - pitch) < 1e-9);
    RC_ASSERT(std::abs(back[2] - yaw) < 1e-9);
  }));
}

// Roll and yaw turn about one axis there: the rotation comes back, not its angles.
TEST(PoseConvention, RotationsComeBackStraightDownAndUp) {
  EXPECT_TRUE(rc::check([] {
    const double off = *rc::gen::element(0.0, 1e-16, 1e-9, 1e-7, 2e-6, 1e-4);
    const double pitch = *rc::gen::element(-1.0, 1.0) * (std::numbers::pi / 2 - off);
    const Pose pose = pose_from_xyz_rpy({1, 2, 3}, within(-3.1, 3.1), pitch, within(-3.1, 3.1));
    const auto [roll, back, yaw] = roll_pitch_yaw(pose);
    RC_ASSERT((pose_from_xyz_rpy({1, 2, 3}, roll, back, yaw).matrix() - pose.matrix()).cwiseAbs().maxCoeff() < 2e-6);
  }));
  const auto angles = roll_pitch_yaw(pose_from_xyz_rpy(Vec3::Zero(), 0, radians(90), radians(30)));
  EXPECT_EQ(angles[0], 0.0);
  EXPECT_NEAR(degrees(angles[1]), 90, 1e-6);
  EXPECT_NEAR(degrees(angles[2]), 30, 1e-9);
}

SonarGeometry geometry() {
  SonarGeometry g;
  g.range_min_m = 0.5;
  g.range_max_m = 4.5;
  g.range_bins = 8;                            // half a metre
  g.beam_azimuth_rad = {0.3, 0.1, 0.0, -0.4};  // uneven
  return g;
}

// Half-open bins: the lower border belongs to a bin, range_max to none.
TEST(Bins, HalfOpen) {
  const SonarGeometry g = geometry();
  EXPECT_EQ(g.bin_of(0.5), 0);
  EXPECT_EQ(g.bin_of(std::nextafter(1.0, 0.0)), 0);
  EXPECT_EQ(g.bin_of(1.0), 1);
  EXPECT_EQ(g.bin_of(std::nextafter(4.5, 0.0)), 7);
  EXPECT_EQ(g.bin_of(4.5), std::nullopt);
  EXPECT_EQ(g.bin_of(std::nextafter(0.5, 0.0)), std::nullopt);
  EXPECT_EQ(g.bin_of(std::nan("")), std::nullopt);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(g.bin_of(g.bin_centre_m(k)), k);
}

TEST(Bins, NeverBeyondTheLastForAnyWindow) {
  EXPECT_TRUE(rc::check([] {
    SonarGeometry g;
    g.range_min_m = within(0.05, 2.0);
    g.range_max_m = g.range_min_m + within(0.1, 40.0);
    g.range_bins = *rc::gen::inRange(1, 2000);
    const auto last = g.bin_of(std::nextafter(g.range_max_m, 0.0));
    RC_ASSERT(last.has_value() && *last == g.range_bins - 1);
    RC_ASSERT(!g.bin_of(g.range_max_m).has_value());
    const int k = *rc::gen::inRange(0, g.range_bins);
    RC_ASSERT(g.bin_of(g.bin_centre_m(k)) == k);
  }));
}

// Cell borders lie midway; the outer ones mirror the inner: 0.4 | 0.3 | 0.2 | 0.1 | 0.05 | 0 | -0.2 | -0.4 | -0.6.
TEST(Beams, CellsOfUnevenBeams) {
  const SonarGeometry g = geometry();
  const std::vector<double> edges = g.beam_edges_rad();
  const std::vector<double> expected{0.4, 0.2, 0.05, -0.2, -0.6};
  ASSERT_EQ(edges.size(), expected.size());
  for (std::size_t i = 0; i < edges.size(); ++i) EXPECT_NEAR(edges[i], expected[i], 1e-15);
  EXPECT_EQ(g.beam_of(0.39), 0);
  EXPECT_EQ(g.beam_of(0.41), std::nullopt);
  EXPECT_EQ(g.beam_of(0.21), 0);
  EXPECT_EQ(g.beam_of(0.19), 1);
  EXPECT_EQ(g.beam_of(0.0), 2);
  EXPECT_EQ(g.beam_of(-0.59), 3);
  EXPECT_EQ(g.beam_of(-0.61), std::nullopt);
  EXPECT_EQ(g.beam_of(std::nan("")), std::nullopt);
  // A border belongs to exactly one of its cells.
  for (int i = 1; i < 4; ++i) {
    const auto beam = g.beam_of(edges[i]);
    ASSERT_TRUE(beam.has_value());
    EXPECT_TRUE(*beam == i || *beam == i - 1);
  }
}

TEST(Image, RowsAreContiguous) {
  Image2<int> image(3, 4, 7);
  image(1, 2) = 5;
  EXPECT_EQ(image.size(), 12u);
  EXPECT_EQ(image.pixels()[6], 5);
  EXPECT_EQ(image.row(1)[2], 5);
  EXPECT_EQ(image.row(2).size(), 4u);
  EXPECT_NE(image, Image2<int>(3, 4, 7));
  EXPECT_TRUE(Image2<float>().empty());
}

}  // namespace
}  // namespace ensonify
