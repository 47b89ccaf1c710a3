// What a single hit counts for.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

// A plate of area A at range r, small, its normal at angle i to the line of sight: E = mu cos^2 i A r^-4. The line of
// sight is that of the actual ray, wherever it points, so that i is the angle to it and not to the sonar's axis.
TEST(SurfaceLaw, IncidenceIsThatOfTheActualRay) {
  const double half = 0.02;
  const double r = 5.0;
  for (const double theta_deg : {-24.0, 0.0, 18.0}) {
    for (const double phi_deg : {-7.0, 0.0, 5.0}) {
      const double theta = radians(theta_deg);
      const double phi = radians(phi_deg);
      const Vec3 d(std::cos(phi) * std::cos(theta), std::cos(phi) * std::sin(theta), std::sin(phi));
      const Vec3 left = Vec3(-std::sin(theta), std::cos(theta), 0.0);
      const Vec3 above = d.cross(left);
      for (const double i_deg : {0.0, 30.0, 60.0}) {
        // Turned about the vertical by i.
        const Vec3 u = std::cos(radians(i_deg)) * left + std::sin(radians(i_deg)) * d;
        SonarSpec spec{.beams = 101, .azimuth_fov_deg = 2.02, .elevation_rays = 2048, .azimuth_rays = 4};
        SonarModel sonar = bare_sonar(spec);
        for (double& azimuth : sonar.geometry.beam_azimuth_rad) azimuth += theta;
        const Ping ping = ping_of(scene_of({plate_mesh(r * d, half * u, half * above)}), sonar, Pose::Identity(), true);
        const double cosine = std::cos(radians(i_deg));
        const double expected = test_mu * cosine * cosine * 4.0 * half * half * std::pow(r, -4);
        EXPECT_NEAR(sum_of(ping.echo.direct) / expected, 1.0, 0.02) << theta_deg << " " << phi_deg << " " << i_deg;
        const auto [bin, beam] = peak_cell(ping.echo.direct);
        EXPECT_NEAR(degrees(ping.truth.incidence_rad(bin, beam)), i_deg, 0.5);
      }
    }
  }
}

// Which way round a triangle's corners run must not matter (float rounding aside).
TEST(SurfaceLaw, BackFacesCountLikeFrontFaces) {
  const SonarModel sonar = bare_sonar({.elevation_rays = 256});
  TriangleMesh front = wall_mesh({3.0, 0, 0}, {-1, 0.3, 0.1});
  TriangleMesh back = front;
  for (auto& t : back.triangles) std::swap(t[0], t[1]);
  const Image2<float> one = ping_of(scene_of({front}), sonar).echo.direct;
  const Image2<float> other = ping_of(scene_of({back}), sonar).echo.direct;
  const float largest = *std::max_element(one.pixels().begin(), one.pixels().end());
  ASSERT_GT(largest, 0.0F);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one.pixels()[i], other.pixels()[i], 1e-3F * largest);
}

// Solid angle: a thin rod that one ray in 40 meets gives 1/40 of a wall's echo, not a wall's pixel. Rod: a strip of
// width w across the whole fan, at D; wall: all elevations within one bin. Strip over wall = (w / D) / arc of the wall
// in the bin, which is 2 acos(D / r_end).
TEST(SurfaceLaw, OneRayIsNoWall) {
  const SonarModel sonar = bare_sonar({.elevation_rays = 1024});
  const int bin = 300;
  const double distance = sonar.geometry.bin_start_m(bin) + 1e-4;
  const double w = 0.004;
  const Scene wall = scene_of({wall_mesh({distance, 0, 0}, {-1, 0, 0})});
  const Scene strip = scene_of({plate_mesh({distance, 0, 0}, {0, 5.0, 0}, {0, 0, 0.5 * w})});
  const double arc = 2.0 * std::acos(distance / sonar.geometry.bin_start_m(bin + 1));
  double strip_sum = 0;
  double wall_sum = 0;
  for (int beam = 62; beam <= 65; ++beam) {  // four neighbours: all four heights of rays
    strip_sum += static_cast<double>(ping_of(strip, sonar).echo.direct(bin, beam));
    wall_sum += static_cast<double>(ping_of(wall, sonar).echo.direct(bin, beam));
  }
  EXPECT_NEAR(strip_sum / wall_sum, w / distance / arc, 0.15 * w / distance / arc);
  EXPECT_LT(strip_sum, 0.05 * wall_sum);
}

}  // namespace
}  // namespace ensonify
