// The image must not depend on how many rays draw it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

/// 8 x 8 blocks: bins 8 i .., beams 8 j ...
constexpr int block = 8;

Image2<double> blocks_of(const Image2<float>& image) {
  Image2<double> blocks(image.rows() / block, image.columns() / block);
  for (int bin = 0; bin < block * blocks.rows(); ++bin) {
    for (int b = 0; b < block * blocks.columns(); ++b) {
      blocks(bin / block, b / block) += static_cast<double>(image(bin, b));
    }
  }
  return blocks;
}

struct Scenery {
  const char* name;
  Scene scene;
  Pose pose;
  double range_max_m;
  std::function<bool(double range_m, double azimuth_rad)> smooth;  ///< may this place be compared?
};

bool anywhere(double, double) { return true; }

/// The Oculus at 2.1 MHz: 512 beams, 12 deg (Hann, so rays reach beyond), 512 bins.
SonarModel oculus(double range_max_m, int rays) {
  SonarModel sonar =
      load_sonar("oculus_m1200d_hf", {.range_min_m = 0.1, .range_max_m = range_max_m, .range_bins = 512});
  sonar.rays.elevation_rays = rays;
  return sonar;
}

std::vector<Scenery> sceneries() {
  std::vector<Scenery> all;
  // Level over a floor 0.26 m below: grazing angles from the edge of the arc down to asin(0.26 / 5) = 3.0 deg.
  all.push_back({"seabed, level", scene_of({floor_mesh(-0.26)}), Pose::Identity(), 5.0, anywhere});
  const Pose pitched = pose_from_xyz_rpy(Vec3::Zero(), radians(3.0), radians(20.0), 0.0);
  all.push_back({"seabed, pitched", scene_of({floor_mesh(-1.2)}), pitched, 5.0, anywhere});
  // Sphere of 1 m, its centre 3 m away: its limb is at 19.5 deg; compared within 15 deg, where incidence < 57 deg.
  all.push_back({"sphere", scene_of({moved(sphere_mesh(1.0, 720, 360), {3.0, 0, 0})}), Pose::Identity(), 5.0,
                 [](double, double azimuth) { return std::abs(azimuth) < radians(15.0); }});
  all.push_back({"wall, 50 deg oblique",
                 scene_of({wall_mesh({2.5, 0, 0}, {-std::cos(radians(50.0)), std::sin(radians(50.0)), 0.1})}),
                 Pose::Identity(), 5.0, anywhere});
  return all;
}

struct Worst {
  double error = 0;
  double range_m = 0;
  double azimuth_deg = 0;
  int compared = 0;
};

/// A block with less than a hundredth of a neighbour's energy is the fringe of an echo's front, not a surface.
bool is_fringe(const Image2<double>& blocks, int i, int j) {
  for (int k = std::max(i - 1, 0); k <= std::min(i + 1, blocks.rows() - 1); ++k) {
    for (int l = std::max(j - 1, 0); l <= std::min(j + 1, blocks.columns() - 1); ++l) {
      if (blocks(i, j) < 1e-2 * blocks(k, l)) return true;
    }
  }
  return false;
}

Worst compare(const Scenery& s, const SonarModel& sonar, const Image2<float>& coarse, const Image2<float>& fine) {
  const Image2<double> a = blocks_of(coarse);
  const Image2<double> b = blocks_of(fine);
  const double largest = *std::max_element(b.pixels().begin(), b.pixels().end());
  Worst worst;
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < a.columns(); ++j) {
      const double range = sonar.geometry.bin_start_m(block * i + block / 2);
      const double port = sonar.geometry.beam_azimuth_rad[block * j];
      const double starboard = sonar.geometry.beam_azimuth_rad[block * j + block - 1];
      // Blocks of next to no energy are left out: below 1e-4 of the largest.
      if (b(i, j) < 1e-4 * largest || is_fringe(b, i, j) || !s.smooth(range, port) || !s.smooth(range, starboard))
        continue;
      ++worst.compared;
      const double error = std::abs(a(i, j) / b(i, j) - 1.0);
      if (error > worst.error) worst = {error, range, degrees(0.5 * (port + starboard)), worst.compared};
    }
  }
  return worst;
}

TEST(RayDensity, BlocksOf128RaysMatch4096WithinTwoPercent) {
  for (const Scenery& s : sceneries()) {
    const SonarModel coarse = oculus(s.range_max_m, 128);
    const SonarModel fine = oculus(s.range_max_m, 4096);
    const Worst worst =
        compare(s, coarse, ping_of(s.scene, coarse, s.pose).echo.direct, ping_of(s.scene, fine, s.pose).echo.direct);
    std::printf("%s: worst of %d blocks %.2f %% at %.2f m, %.1f deg\n", s.name, worst.compared, 100 * worst.error,
                worst.range_m, worst.azimuth_deg);
    EXPECT_GT(worst.compared, 100) << s.name;
    EXPECT_LT(worst.error, 0.02) << s.name << " at " << worst.range_m << " m, " << worst.azimuth_deg << " deg";
  }
}

// Twice the rays, in elevation or in azimuth: the same energy within 1 %, from the default count up.
TEST(RayDensity, DoublingRaysKeepsTheEnergy) {
  for (const Scenery& s : sceneries()) {
    const double once = sum_of(ping_of(s.scene, oculus(s.range_max_m, 0), s.pose).echo.direct);
    for (const int rays : {256, 512}) {
      EXPECT_NEAR(sum_of(ping_of(s.scene, oculus(s.range_max_m, rays), s.pose).echo.direct) / once, 1.0, 0.01)
          << s.name << " " << rays;
    }
    SonarModel twice_azimuth = oculus(s.range_max_m, 0);
    twice_azimuth.rays.azimuth_rays_per_beam = 2;
    EXPECT_NEAR(sum_of(ping_of(s.scene, twice_azimuth, s.pose).echo.direct) / once, 1.0, 0.01) << s.name;
  }
}

// Flat seabed below a level sonar, height h: E(r) = mu h^2 r^-5 B(asin(h / r))^2 dr dtheta (see spreading_test), so
// with the box pattern E r^5 is one number: what varies from bin to bin is a stripe. Every beam, every bin, at the
// default ray count.
TEST(RayDensity, NoStripesOnASeabed) {
  for (const double h : {0.26, 0.8}) {
    SonarModel sonar = oculus(5.0, 0);
    sonar.elevation = Aperture(Shading::box, radians(24.0));
    sonar.frequency_hz = 1.0;
    sonar.fan_edge_db = 0.0;
    const Image2<float> echo = ping_of(scene_of({floor_mesh(-h)}), sonar).echo.direct;
    // From where the arc's lower border meets the floor, and a step of elevation (24 deg / 112) further, to the end.
    const int first = *sonar.geometry.bin_of(h / std::sin(radians(11.5)));
    double worst = 0;
    double worst_level = 0;
    for (int beam = 0; beam < sonar.geometry.beams(); ++beam) {
      const double cell = sonar.geometry.beam_edges_rad()[beam] - sonar.geometry.beam_edges_rad()[beam + 1];
      double before = 0;
      for (int bin = first; bin < sonar.geometry.range_bins; ++bin) {
        const double r = sonar.geometry.bin_centre_m(bin);
        const double flat = static_cast<double>(echo(bin, beam)) * std::pow(r, 5) /
                            (test_mu * h * h * cell * sonar.geometry.bin_size_m());
        if (before > 0) worst = std::max(worst, std::abs(flat / before - 1.0));
        worst_level = std::max(worst_level, std::abs(flat - 1.0));
        before = flat;
      }
    }
    std::printf("height %.2f m: worst step between bins %.2f %%, worst level %.2f %%\n", h, 100 * worst,
                100 * worst_level);
    EXPECT_LT(worst, 0.02) << h;
    EXPECT_LT(worst_level, 0.02) << h;
  }
}

}  // namespace
}  // namespace ensonify
