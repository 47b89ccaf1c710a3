// A sonar that moves while the sound is under way. An echo of range r is received t = 2 r / c after the pulse.
#include "ensonify/sim/ping_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double c = 1500.0;

SonarGeometry geometry() {
  return bare_sonar({.beams = 401, .azimuth_fov_deg = 60, .range_min_m = 1, .range_max_m = 41, .bins = 4000}).geometry;
}

/// Energy-weighted bin and beam of what one cell becomes.
std::pair<double, double> moved_to(int bin, int beam, const Twist& motion, float elevation_rad = 0.0F) {
  const SonarGeometry g = geometry();
  Echo echo{Image2<float>(g.range_bins, g.beams()), {}, Image2<float>(g.range_bins, g.beams(), elevation_rad)};
  echo.direct(bin, beam) = 2.0F;
  const Echo moved = receive_in_motion(echo, g, motion, c);
  EXPECT_NEAR(sum_of(moved.direct), 2.0, 1e-5);
  double row = 0, column = 0;
  for (int i = 0; i < g.range_bins; ++i) {
    for (int b = 0; b < g.beams(); ++b) {
      row += 0.5 * static_cast<double>(moved.direct(i, b)) * i;
      column += 0.5 * static_cast<double>(moved.direct(i, b)) * b;
    }
  }
  return {row, column};
}

TEST(PingMotion, StillChangesNothing) {
  const SonarGeometry g = geometry();
  Echo echo{Image2<float>(g.range_bins, g.beams(), 0.3F), {}, {}};
  EXPECT_EQ(receive_in_motion(echo, g, {}, c).direct, echo.direct);
}

// Ahead at v: the way home is v t shorter, the echo lies v t / 2 = v r / c nearer. 10 m/s, 30 m: 20 cm, 20 bins.
TEST(PingMotion, AheadShortensTheRange) {
  const auto [bin, beam] = moved_to(2900, 200, {{10, 0, 0}, Vec3::Zero()});
  const double r = geometry().bin_centre_m(2900);
  EXPECT_NEAR(2900 - bin, 10.0 * r / c / 0.01, 0.01);
  EXPECT_NEAR(beam, 200.0, 1e-6);
}

// Turning to port by w: a target ahead is received w t to starboard of the axis, at higher beam numbers.
TEST(PingMotion, TurningShiftsTheBearing) {
  const double w = radians(20.0);
  const auto [bin, beam] = moved_to(3900, 200, {Vec3::Zero(), {0, 0, w}});
  const SonarGeometry g = geometry();
  const double turned_rad = w * 2.0 * g.bin_centre_m(3900) / c;
  EXPECT_NEAR(beam - 200.0, turned_rad / (g.beam_azimuth_rad[200] - g.beam_azimuth_rad[201]), 0.01);
  EXPECT_NEAR(bin, 3900.0, 0.1);
}

// To port at v: a target ahead is received v t / r = 2 v / c to starboard, whatever its range.
TEST(PingMotion, SwayingShiftsTheBearing) {
  const SonarGeometry g = geometry();
  const double expected = 2.0 * 5.0 / c / (g.beam_azimuth_rad[200] - g.beam_azimuth_rad[201]);
  for (const int bin : {500, 3500}) {
    EXPECT_NEAR(moved_to(bin, 200, {{0, 5, 0}, Vec3::Zero()}).second - 200.0, expected, 0.01);
  }
}

// Rising at v towards a target above at elevation phi: nearer by v sin(phi) r / c.
TEST(PingMotion, KnowsTheElevation) {
  const double r = geometry().bin_centre_m(2900);
  const auto [bin, beam] = moved_to(2900, 200, {{0, 0, 10}, Vec3::Zero()}, 0.3F);
  EXPECT_NEAR(2900 - bin, 10.0 * std::sin(0.3) * r / c / 0.01, 0.15);
}

}  // namespace
}  // namespace ensonify
