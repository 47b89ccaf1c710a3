// Closed-form levels of a Lambert plane. With dA = r^2 dOmega / cos i the echo of a solid angle is
//   dE = mu cos i dOmega r^-2 B(phi)^2,   B the one-way elevation pattern, dOmega = cos phi dphi dtheta.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/sensor_models/receive_chain.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

/// Power of a Hann-weighted line (Harris 1978): [sin(pi x) / (pi x (1 - x^2))]^2, half at x = 0.7203.
double hann_power(double phi, double width) {
  const double x = 0.72030 * std::sin(phi) / std::sin(0.5 * width);
  if (std::abs(x) < 1e-9) return 1.0;
  const double a = std::sin(std::numbers::pi * x) / (std::numbers::pi * x * (1.0 - x * x));
  return a * a;
}

/// Power of an unweighted line: sinc^2, half at x = 0.44295.
double uniform_power(double phi, double width) {
  const double x = std::numbers::pi * 0.44295 * std::sin(phi) / std::sin(0.5 * width);
  return std::abs(x) < 1e-9 ? 1.0 : std::pow(std::sin(x) / x, 2);
}

// Plane facing the sonar at distance D: cos i = cos phi cos theta, r = D / (cos phi cos theta), so a beam at theta of
// width dtheta sums to mu D^-2 cos^3(theta) dtheta int cos^4(phi) B^2 dphi.
TEST(AbsoluteLevel, FacingPlaneWithElevationPattern) {
  for (const double distance : {1.5, 3.0, 7.0}) {
    for (const Shading shading : {Shading::box, Shading::uniform, Shading::hann}) {
      const double fov = radians(20.0);
      const SonarModel sonar = bare_sonar({.azimuth_fov_deg = 38.7, .elevation = shading});
      const Ping ping = ping_of(scene_of({wall_mesh({distance, 0, 0}, {-1, 0, 0})}), sonar);
      const double arc = shading == Shading::box ? 0.5 * fov : radians(30.0);
      const double elevation = integral(-arc, arc, [&](double phi) {
        const double b = shading == Shading::box    ? 1.0
                         : shading == Shading::hann ? hann_power(phi, fov)
                                                    : uniform_power(phi, fov);
        return std::pow(std::cos(phi), 4) * b * b;
      });
      for (const int beam : {4, 30, 64, 110}) {
        const double theta = radians(0.3 * (64 - beam));
        const double expected =
            test_mu / (distance * distance) * std::pow(std::cos(theta), 3) * radians(0.3) * elevation;
        EXPECT_NEAR(beam_sum(ping.echo.direct, beam) / expected, 1.0, 0.01)
            << "distance " << distance << " shading " << static_cast<int>(shading) << " beam " << beam;
      }
    }
  }
}

// Specular lobe: the same integral with sigma = s cos^n i gives cos^(n + 2) in place of cos^4 (theta = 0).
TEST(AbsoluteLevel, SpecularLobe) {
  Scene scene = scene_of({wall_mesh({4.0, 0, 0}, {-1, 0, 0})});
  scene.materials[0] = {"mirror", -300.0, -3.0, 200.0, "test"};
  const Ping ping = ping_of(scene, bare_sonar());
  const double s = std::pow(10.0, -0.3);
  const double expected = s / 16.0 * radians(0.1) * integral(-radians(10.0), radians(10.0), [](double phi) {
                            return std::pow(std::cos(phi), 202);
                          });
  EXPECT_NEAR(beam_sum(ping.echo.direct, 64) / expected, 1.0, 0.01);
}

// Fan pattern: a two-way loss quadratic in azimuth, 0 dB on the axis and fan_edge_db at the border of the fan.
TEST(AbsoluteLevel, FanPattern) {
  SonarModel sonar = bare_sonar();
  const Scene scene = scene_of({wall_mesh({4.0, 0, 0}, {-1, 0, 0})});
  const Ping flat = ping_of(scene, sonar);
  sonar.fan_edge_db = 6.0;
  const Ping shaped = ping_of(scene, sonar);
  for (const int beam : {0, 20, 64, 128}) {
    const double share = 0.1 * (64 - beam) / 6.45;
    EXPECT_NEAR(10.0 * std::log10(beam_sum(flat.echo.direct, beam) / beam_sum(shaped.echo.direct, beam)),
                6.0 * share * share, 0.01)
        << beam;
  }
}

// Sonar equation end to end: EL = SL - 2 TL + TS with TL = 20 log r + alpha r and, for a Lambert sphere,
// TS = 10 log10(2 pi a^2 mu / 3). A receiver with TVG 40 log r + 2 alpha r shows SL + TS - saturation at any range.
TEST(AbsoluteLevel, SonarEquationOfASphere) {
  for (const double r : {2.0, 4.0, 8.0}) {
    SonarModel sonar = bare_sonar({.beams = 64,
                                   .azimuth_fov_deg = 4.0,
                                   .elevation_fov_deg = 4.0,
                                   .bins = 19,  // half a metre a bin: all of the sphere in one
                                   .elevation_rays = 1024,
                                   .azimuth_rays = 4});
    sonar.geometry.range_min_m = r - 0.25 - 2 * 0.5;
    sonar.geometry.range_max_m = sonar.geometry.range_min_m + 9.5;
    sonar.frequency_hz = 2.1e6;
    sonar.receive = {40.0, 1.418, 220.0, 1.0, 8};
    const double a = 0.02;
    const Ping ping = ping_of(scene_of({moved(sphere_mesh(a, 192, 96), {r + 0.75 * a, 0, 0})}), sonar);
    Image2<float> one(ping.echo.direct.rows(), 1);
    for (int bin = 0; bin < one.rows(); ++bin) {
      for (int b = 0; b < 64; ++b) one(bin, 0) += ping.echo.direct(bin, b);
    }
    const Image2<float> level = receive(sonar, one);
    const double ts = 10.0 * std::log10(2.0 * std::numbers::pi * a * a * test_mu / 3.0);
    EXPECT_EQ(peak_bin(level, 0), 2);
    EXPECT_NEAR(20.0 * std::log10(static_cast<double>(level(2, 0))), ts, 0.1) << r;
  }
}

}  // namespace
}  // namespace ensonify
