#include "ensonify/generators/smoothed_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

PoseVector knot(double x, double y, double z, double yaw_deg = 0, double pitch_deg = 0) {
  PoseVector v;
  v << x, y, z, 0, radians(pitch_deg), radians(yaw_deg);
  return v;
}

double distance_m(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - share * (b - a)).norm();
}

const std::vector<PoseVector> corner{knot(0, 0, -1), knot(4, 0, -1, 90), knot(4, 3, -1, 170)};

/// Central differences of the position.
Vec3 velocity(const SmoothedWay& way, double s) { return (way.at(s + 1e-4) - way.at(s - 1e-4)).head<3>() / 2e-4; }
Vec3 acceleration(const SmoothedWay& way, double s) {
  return (way.at(s + 1e-3) - 2 * way.at(s) + way.at(s - 1e-3)).head<3>() / 1e-6;
}

// Straight legs are kept, the corner is cut by 5/32 h |d_out - d_in|, the ends are reached at rest.
TEST(SmoothedWay, KeepsStraightsCutsCornersReachesEnds) {
  constexpr double h = 0.8;
  const SmoothedWay way = there_and_back(corner, h);
  const double over = 5.0 / 16 * h;
  EXPECT_NEAR(way.period_m(), 2 * (4 + 3) + 4 * over, 1e-12);
  EXPECT_LT((way.at(0) - corner[0]).head<3>().norm(), 1e-12);
  EXPECT_LT((way.at(0.5 * way.period_m()) - corner[2]).head<3>().norm(), 1e-12);
  EXPECT_LT(velocity(way, 0).norm(), 1e-3);
  EXPECT_LT(velocity(way, 0.5 * way.period_m()).norm(), 1e-3);
  EXPECT_TRUE(way.at(over + 2).head<3>().isApprox(Vec3(2, 0, -1), 1e-12));
  EXPECT_NEAR(way.at(over + 2)[5], radians(45), 1e-12);
  EXPECT_TRUE(way.at(over + 5.5).head<3>().isApprox(Vec3(4, 1.5, -1), 1e-12));
  EXPECT_NEAR(way.at(over + 5.5)[5], radians(130), 1e-12);
  EXPECT_TRUE(way.at(over + 4).head<3>().isApprox(Vec3(4 - 5.0 / 32 * h, 5.0 / 32 * h, -1), 1e-12));
}

TEST(SmoothedWay, GoesBackAsItCameForEver) {
  const SmoothedWay way = there_and_back(corner, 1.0);
  const double period = way.period_m();
  for (double s = 0; s < period; s += 0.037) {
    EXPECT_TRUE(way.at(s).isApprox(way.at(period - s), 1e-9)) << s;
    EXPECT_TRUE(way.at(s).isApprox(way.at(s + 5 * period), 1e-9)) << s;
    EXPECT_TRUE(way.at(s).isApprox(way.at(s - period), 1e-9)) << s;
  }
}

// The bounds of the header, for corners of every sharpness: speed at most 1, acceleration at most 15/8 sin(alpha / 2) /
// h of v^2 and reached, distance from the legs at most 5/16 h.
TEST(SmoothedWay, KeepsItsBounds) {
  for (const double h : {0.3, 1.0}) {
    for (const double alpha_deg : {5.0, 45.0, 90.0, 150.0}) {
      const double a = radians(alpha_deg);
      const std::vector<PoseVector> knots{knot(0, 0, 0), knot(5, 0, 0), knot(5 + 5 * std::cos(a), 5 * std::sin(a), 0)};
      const SmoothedWay way = there_and_back(knots, h);
      double most = 0;
      for (double s = 2; s < 8; s += 0.01) {
        EXPECT_LE(velocity(way, s).norm(), 1 + 1e-7);
        most = std::max(most, acceleration(way, s).norm());
        const Vec3 p = way.at(s).head<3>();
        EXPECT_LE(std::min(distance_m(p, knots[0].head<3>(), knots[1].head<3>()),
                           distance_m(p, knots[1].head<3>(), knots[2].head<3>())),
                  5.0 / 16 * h);
      }
      EXPECT_NEAR(most, 15.0 / 8 / h * std::sin(a / 2), 1e-3 * most) << alpha_deg;
    }
  }
}

// Nothing jumps up to the third derivative: between samples 1e-3 apart the second differs by at most its slope.
TEST(SmoothedWay, AccelerationIsContinuous) {
  const SmoothedWay way = there_and_back(
      {knot(0, 0, -1), knot(2, 0, -1, 90), knot(2, 0, -1, 170), knot(2, 0.5, -1.2, 100), knot(0, 0.5, -1.2, 10, 30)},
      0.6);
  PoseVector last = PoseVector::Zero();
  for (double s = -1; s < way.period_m() + 1; s += 1e-3) {
    const PoseVector second = (way.at(s + 1e-3) - 2 * way.at(s) + way.at(s - 1e-3)) / 1e-6;
    ASSERT_TRUE(second.allFinite());
    // |K'| is at most 1.44 / h^2, times what the legs change a metre: rates of at most 80 degrees on the spot count by
    // h.
    if (s > -1) {
      ASSERT_LT((second - last).norm(), 0.1) << s;
    }
    last = second;
  }
}

TEST(SmoothedWay, NeedsAWayAndStandsStillWhereAsked) {
  EXPECT_THROW(there_and_back({}, 1.0), ConfigError);
  EXPECT_THROW(there_and_back({knot(0, 0, 0)}, 1.0), ConfigError);
  EXPECT_THROW(there_and_back({knot(0, 0, 0), knot(0, 0, 0, 90)}, 1.0), ConfigError);
  // A way shorter than the rounding is still swum, between its ends.
  const SmoothedWay tiny = there_and_back({knot(0, 0, 0), knot(0.1, 0, 0)}, 10.0);
  double low = 1, high = 0;
  for (double s = 0; s < 1; s += 0.001) {
    const double x = tiny.at(s)[0];
    low = std::min(low, x);
    high = std::max(high, x);
  }
  EXPECT_NEAR(low, 0.0, 1e-6);
  EXPECT_NEAR(high, 0.1, 1e-6);
}

// Round a square: no rest, a whole turn of yaw a round, no seam.
TEST(SmoothedWay, RoundHasNoSeam) {
  const SmoothedWay way =
      round_and_round({knot(0, 0, 0, 0), knot(2, 0, 0, 90), knot(2, 2, 0, 180), knot(0, 2, 0, -90)}, 0.5);
  EXPECT_NEAR(way.period_m(), 8.0, 1e-12);
  for (double s = 0; s < 8; s += 0.01) {
    EXPECT_GT(velocity(way, s).norm(), std::cos(radians(45)) - 1e-6) << s;
    EXPECT_TRUE(pose_of(way.at(s)).isApprox(pose_of(way.at(s + 24)), 1e-9)) << s;
  }
  EXPECT_TRUE(pose_of(way.at(-1e-9)).isApprox(pose_of(way.at(8 - 1e-9)), 1e-9));
  EXPECT_TRUE(pose_of(way.at(8 - 1e-9)).isApprox(pose_of(way.at(8 + 1e-9)), 1e-8));
}

TEST(SmoothedWay, AnglesTurnTheShortWayAndSurviveLookingStraightDown) {
  const auto turned = unwrapped({knot(0, 0, 0, 170), knot(1, 0, 0, -170), knot(2, 0, 0, 100)});
  EXPECT_NEAR(turned[1][5], radians(190), 1e-12);
  EXPECT_NEAR(turned[2][5], radians(100), 1e-12);
  for (const double yaw_deg : {-120.0, 0.0, 33.0}) {
    const Pose down = pose_from_xyz_rpy({1, 2, -3}, 0, radians(90), radians(yaw_deg));
    EXPECT_TRUE(pose_of(vector_of(down)).isApprox(down, 1e-7));
    EXPECT_NEAR(vector_of(down)[5], radians(yaw_deg), 1e-7);
    EXPECT_EQ(vector_of(down)[3], 0.0);
  }
}

}  // namespace
}  // namespace ensonify
