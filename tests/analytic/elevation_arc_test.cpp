// A cell sums all that lies on its elevation arc; the image keeps no elevation, the truth does.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double range_m = 5.0;
constexpr double radius_m = 0.03;

TriangleMesh ball_at(double elevation_deg) {
  const double phi = radians(elevation_deg);
  return moved(sphere_mesh(radius_m, 96, 48), {range_m * std::cos(phi), 0, range_m * std::sin(phi)});
}

SonarModel sonar() {
  return bare_sonar({.beams = 65,
                     .azimuth_fov_deg = 3.25,
                     .elevation_fov_deg = 12.0,
                     .elevation = Shading::hann,
                     .elevation_rays = 4096,
                     .azimuth_rays = 2});
}

// Neither hides the other, so cell by cell E(both) = E(one) + E(other).
TEST(ElevationArc, EnergiesAdd) {
  const Ping up = ping_of(scene_of({ball_at(3.0)}), sonar());
  const Ping down = ping_of(scene_of({ball_at(-4.0)}), sonar());
  const Ping both = ping_of(scene_of({ball_at(3.0), ball_at(-4.0)}), sonar());
  ASSERT_GT(sum_of(up.echo.direct), 0.0);
  const float largest = *std::max_element(both.echo.direct.pixels().begin(), both.echo.direct.pixels().end());
  for (std::size_t i = 0; i < both.echo.direct.size(); ++i) {
    EXPECT_NEAR(both.echo.direct.pixels()[i], up.echo.direct.pixels()[i] + down.echo.direct.pixels()[i],
                1e-5F * largest);
  }
}

// Elevation extent of a ball: phi +- asin(a / r); the strongest echo of a cell is the ball nearer to the axis.
TEST(ElevationArc, TruthNamesExtentAndStrongest) {
  const SonarModel instrument = sonar();
  const Ping both = ping_of(scene_of({ball_at(3.0), ball_at(-4.0)}), instrument, Pose::Identity(), true);
  const int bin = *instrument.geometry.bin_of(range_m - 0.9 * radius_m);
  // Of a sphere, the part within x of its front is a cap of half angle acos(1 - x / a).
  const double x = instrument.geometry.bin_start_m(bin + 1) - (range_m - radius_m);
  const double cap = std::asin(radius_m * std::sin(std::acos(1.0 - x / radius_m)) / (range_m - radius_m));
  EXPECT_NEAR(both.truth.elevation_max_rad(bin, 32), radians(3.0) + cap, radians(0.03));
  EXPECT_NEAR(both.truth.elevation_min_rad(bin, 32), radians(-4.0) - cap, radians(0.03));
  EXPECT_NEAR(both.truth.elevation_strongest_rad(bin, 32), radians(3.0), cap);
  EXPECT_EQ(both.truth.instance(bin, 32), 0);
  EXPECT_LT(both.truth.incidence_rad(bin, 32), radians(60.0));
  const int empty = *instrument.geometry.bin_of(range_m + 0.5);
  EXPECT_TRUE(std::isnan(both.truth.elevation_min_rad(empty, 32)));
  EXPECT_EQ(both.truth.instance(empty, 32), -1);
}

// Same ball, other elevation: the ratio of the echoes is the two-way pattern, B(phi)^2 with B the Hann line's power
// [sin(pi x) / (pi x (1 - x^2))]^2, x = 0.7203 sin phi / sin 6 deg, averaged over the ball (which is small).
TEST(ElevationArc, TwoWayPattern) {
  const auto two_way = [](double phi_deg) {
    const double x = 0.72030 * std::sin(radians(phi_deg)) / std::sin(radians(6.0));
    if (std::abs(x) < 1e-9) return 1.0;
    const double a = std::sin(std::numbers::pi * x) / (std::numbers::pi * x * (1.0 - x * x));
    return a * a * a * a;
  };
  ASSERT_NEAR(two_way(6.0), 0.25, 1e-4);  // -3 dB each way
  const double axis = sum_of(ping_of(scene_of({ball_at(0.0)}), sonar()).echo.direct);
  for (const double phi_deg : {-8.0, -4.0, 2.0, 3.0, 6.0, 9.0}) {
    const double echo = sum_of(ping_of(scene_of({ball_at(phi_deg)}), sonar()).echo.direct);
    EXPECT_NEAR(echo / axis / two_way(phi_deg), 1.0, 0.02) << phi_deg;
  }
}

}  // namespace
}  // namespace ensonify
