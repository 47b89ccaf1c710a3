// Laws of range (Urick 1983, sonar equation; reference: echo of a patch dA is sigma(i) dA r^-4 10^(-0.2 alpha r)).
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr double ranges_m[] = {2.0, 3.0, 4.5, 6.5, 9.0};

/// Echo of a Lambert sphere of radius a whose centre is r away: rings of polar angle psi, area 2 pi a^2 sin psi dpsi,
/// seen from distance s with cos i = (r cos psi - a) / s.
double sphere_echo(double a, double r) {
  const double horizon = std::acos(a / r);
  return integral(0.0, horizon, [&](double psi) {
    const double s = std::sqrt(r * r + a * a - 2.0 * r * a * std::cos(psi));
    const double cosine = (r * std::cos(psi) - a) / s;
    return test_mu * cosine * cosine * 2.0 * std::numbers::pi * a * a * std::sin(psi) / std::pow(s, 4);
  });
}

SonarModel narrow_sonar() {
  return bare_sonar(
      {.beams = 128, .azimuth_fov_deg = 4.0, .elevation_fov_deg = 4.0, .elevation_rays = 1024, .azimuth_rays = 4});
}

/// A sphere in front, 2 cm.
Scene sphere_at(double r) { return scene_of({moved(sphere_mesh(0.02, 192, 96), {r, 0, 0})}); }

// Point target: E = r^-4 int sigma dA; the sphere's integral for a << r is 2 pi a^2 mu / 3.
TEST(Spreading, SmallTargetFallsAsFourthPower) {
  std::vector<double> log_r;
  std::vector<double> log_e;
  for (const double r : ranges_m) {
    const double echo = sum_of(ping_of(sphere_at(r), narrow_sonar()).echo.direct);
    EXPECT_NEAR(echo / sphere_echo(0.02, r), 1.0, 0.01) << r;
    EXPECT_NEAR(echo * std::pow(r, 4) / (2.0 * std::numbers::pi * 0.02 * 0.02 * test_mu / 3.0), 1.0, 0.05) << r;
    log_r.push_back(std::log(r - 0.75 * 0.02));  // the echo's mean place: <cos> = int cos^3 / int cos^2 = 3/4
    log_e.push_back(std::log(echo));
  }
  RecordProperty("slope", std::to_string(slope_of(log_r, log_e)));
  EXPECT_NEAR(slope_of(log_r, log_e), -4.0, 0.01);
}

// Flat seabed a height h below: between slant ranges r and r + dr and azimuths dtheta lies dA = rho drho dtheta =
// r dr dtheta, at sin(grazing) = cos i = h / r. Lambert: E = mu (h / r)^2 r^-3 dr dtheta.
//  - fixed grazing angle (h grows with r): r^-3;   - fixed height: r^-5.
TEST(Spreading, SeabedBinFallsAsThirdPowerAtFixedGrazingAndFifthAtFixedHeight) {
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 60.0, .elevation_rays = 1024});
  const double cell = sonar.geometry.bin_size_m() * radians(0.1);
  const auto echo_at = [&](double height, double r, double& centre) {
    const int bin = *sonar.geometry.bin_of(r);
    centre = sonar.geometry.bin_centre_m(bin);
    return ping_of(scene_of({floor_mesh(-height)}), sonar).echo.direct(bin, 64);
  };
  std::vector<double> log_r;
  std::vector<double> fixed_grazing;
  std::vector<double> fixed_height;
  const double sine = std::sin(radians(12.0));
  for (const double r : ranges_m) {
    double centre = 0;
    const double nominal = sonar.geometry.bin_centre_m(*sonar.geometry.bin_of(r));
    const double scaled = echo_at(nominal * sine, r, centre);
    EXPECT_NEAR(scaled / (test_mu * sine * sine * std::pow(centre, -3) * cell), 1.0, 0.01) << r;
    const double fixed = echo_at(0.9, r, centre);
    EXPECT_NEAR(fixed / (test_mu * 0.81 * std::pow(centre, -5) * cell), 1.0, 0.01) << r;
    log_r.push_back(std::log(centre));
    fixed_grazing.push_back(std::log(scaled));
    fixed_height.push_back(std::log(fixed));
  }
  EXPECT_NEAR(slope_of(log_r, fixed_grazing), -3.0, 0.01);
  EXPECT_NEAR(slope_of(log_r, fixed_height), -5.0, 0.01);
}

// Two-way loss 2 alpha r in dB: the same scene at 2.1 MHz over the same at 1 Hz leaves absorption alone. alpha = 1.418
// dB/m is Francois and Garrison's for sea water of 10 C, 35 psu, 5 m, pH 8 at 2.1 MHz.
TEST(Spreading, AbsorptionIsTwoWay) {
  std::vector<double> r_m;
  std::vector<double> loss_db;
  for (const double r : ranges_m) {
    SonarModel sonar = narrow_sonar();
    const double clear = sum_of(ping_of(sphere_at(r), sonar).echo.direct);
    sonar.frequency_hz = 2.1e6;
    r_m.push_back(r);
    loss_db.push_back(10.0 * std::log10(clear / sum_of(ping_of(sphere_at(r), sonar).echo.direct)));
    EXPECT_NEAR(loss_db.back(), 2.0 * 1.418 * (r - 0.015), 0.05) << r;
  }
  EXPECT_NEAR(slope_of(r_m, loss_db), 2.0 * 1.418, 0.01);
}

}  // namespace
}  // namespace ensonify
