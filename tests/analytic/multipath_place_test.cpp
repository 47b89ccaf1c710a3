// Where ghosts land, against image sources (support/image_source.hpp): half the path, bearing of the last leg.
#include <gtest/gtest.h>

#include <cmath>

#include "support/image_source.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

SonarModel wide_sonar() { return bare_sonar({.beams = 301, .azimuth_fov_deg = 60.2, .range_max_m = 8.0, .bins = 750}); }

/// Slope 1 / sqrt(20000) = 0.4 degrees, no Lambert part.
const Material mirror{"mirror", -300.0, 29.0, 20000.0, "test"};

/// Mirror first, then a Lambert target.
Scene with_mirror(const TriangleMesh& wall, const TriangleMesh& target) {
  Scene scene = scene_of({wall, target});
  scene.materials.push_back(mirror);
  scene.instances[0].material = 1;
  return scene;
}

std::vector<Vec3> points_of_plate(const Vec3& centre, const Vec3& u, const Vec3& v, int steps = 60) {
  std::vector<Vec3> points;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j)
      points.emplace_back(centre + u * (2.0 * i / steps - 1) + v * (2.0 * j / steps - 1));
  }
  return points;
}

/// Share of the energy of some beams that lies within one bin and `beam_slack` beams of a ghost.
double share_near(const Image2<float>& layer, const std::vector<Ghost>& ghosts, int first_beam, int last_beam,
                  int bin_slack, int beam_slack) {
  Image2<float> near(layer.rows(), layer.columns());
  for (const Ghost& g : ghosts) {
    for (int bin = std::max(0, g.bin - bin_slack); bin <= std::min(layer.rows() - 1, g.bin + bin_slack); ++bin) {
      for (int beam = std::max(0, g.beam - beam_slack); beam <= std::min(layer.columns() - 1, g.beam + beam_slack);
           ++beam) {
        near(bin, beam) = 1.0f;
      }
    }
  }
  double inside = 0.0;
  double all = 0.0;
  for (int bin = 0; bin < layer.rows(); ++bin) {
    for (int beam = first_beam; beam <= last_beam; ++beam) {
      all += static_cast<double>(layer(bin, beam));
      inside += static_cast<double>(near(bin, beam) * layer(bin, beam));
    }
  }
  return all > 0.0 ? inside / all : 0.0;
}

double share_of_ghosts_lit(const Image2<float>& layer, const std::vector<Ghost>& ghosts, float least) {
  int lit = 0;
  for (const Ghost& g : ghosts) {
    bool any = false;
    for (int bin = std::max(0, g.bin - 1); bin <= std::min(layer.rows() - 1, g.bin + 1); ++bin) {
      for (int beam = std::max(0, g.beam - 1); beam <= std::min(layer.columns() - 1, g.beam + 1); ++beam) {
        any = any || layer(bin, beam) > least;
      }
    }
    lit += any ? 1 : 0;
  }
  return ghosts.empty() ? 0.0 : 1.0 * lit / static_cast<double>(ghosts.size());
}

struct MirrorCase {
  Vec3 wall_point, wall_normal, centre, half_u, half_v;
};

// A wall beside, a floor below and a surface above a target plate. The half length does not depend on where the path
// meets a flat mirror to first order (Fermat), so bins are sharp. At the bearing of the target they are all that there
// is; the bearing of the specular point is blurred by the lobe: facets tilted by 0.4 degrees shift it by about
// 2 * 0.4 / cos(incidence) degrees * d / (d + r) on the wall, here within 1.6 degrees or 8 beams of 0.2 degrees.
TEST(MultipathPlace, GhostsOfATargetInAMirror) {
  const std::vector<MirrorCase> cases{
      {{0, 1.0, 0}, {0, -1, 0}, {5.0, -0.4, 0}, Vec3(0.05, 0.2, 0), Vec3(0, 0, 0.2)},         // wall to port
      {{0, 0, -0.25}, {0, 0, 1}, {4.0, 0.5, 0.05}, Vec3(0.0, 0.2, 0), Vec3(0.02, 0, 0.1)},    // floor
      {{0, 0, 0.25}, {0, 0, -1}, {4.0, -0.8, 0.0}, Vec3(0.02, 0.15, 0), Vec3(0.02, 0, 0.1)},  // water surface
  };
  const SonarModel sonar = wide_sonar();
  for (const MirrorCase& c : cases) {
    const Scene scene =
        with_mirror(wall_mesh(c.wall_point, c.wall_normal, 20.0), plate_mesh(c.centre, c.half_u, c.half_v));
    const RayScene rays(scene);
    const Image2<float> layer = MultipathTracer(rays, sonar, scene.water).trace(Pose::Identity(), 2);
    const std::vector<Ghost> ghosts =
        ghosts_of(rays, {c.wall_point, c.wall_normal}, points_of_plate(c.centre, c.half_u, c.half_v), sonar.geometry,
                  Pose::Identity());
    std::vector<Ghost> at_target;
    std::vector<Ghost> at_mirror;
    for (const Ghost& g : ghosts) (g.by_mirror ? at_mirror : at_target).push_back(g);
    ASSERT_GT(at_target.size(), 500u);
    const auto [low, high] = std::minmax_element(at_target.begin(), at_target.end(),
                                                 [](const Ghost& x, const Ghost& y) { return x.beam < y.beam; });
    EXPECT_GT(share_near(layer, at_mirror.empty() ? at_target : ghosts, 0, 300, 1, 8), 0.9)
        << c.wall_normal.transpose();
    EXPECT_GT(share_near(layer, ghosts, low->beam, high->beam, 1, 1), 0.75) << c.wall_normal.transpose();
    const double mean = sum_of(layer) / static_cast<double>(at_target.size());
    EXPECT_GT(share_of_ghosts_lit(layer, at_target, static_cast<float>(1e-3 * mean)), 0.95)
        << c.wall_normal.transpose();
  }
}

// Two perpendicular mirrors, edge upright at (3, 0): the image of the sonar in both is at (6, 0), straight behind the
// edge, so no path is shorter than twice the 3 m to the edge, and that one arrives from the edge. Facets tilted by a
// few tenths of a degree let neighbouring bearings return as well, after a longer way.
TEST(MultipathPlace, DihedralReturnsFromItsEdge) {
  const double edge = 3.0;
  Scene scene = scene_of({plate_mesh({edge - 1.0, 1.0, 0}, {-1, 1, 0}, {0, 0, 3}),
                          plate_mesh({edge - 1.0, -1.0, 0}, {1, 1, 0}, {0, 0, 3})});
  scene.materials[0] = mirror;
  const SonarModel sonar = wide_sonar();
  const RayScene rays(scene);
  const Image2<float> layer = MultipathTracer(rays, sonar, scene.water).trace(Pose::Identity(), 2);
  const int bin = *sonar.geometry.bin_of(edge);
  const auto [peak_row, peak_beam] = peak_cell(layer);
  EXPECT_NEAR(peak_row, bin, 1);
  double before = 0.0;
  double azimuth_moment = 0.0;
  for (int row = 0; row < layer.rows(); ++row) {
    for (int beam = 0; beam < layer.columns(); ++beam) {
      if (row < bin - 1) before += static_cast<double>(layer(row, beam));
      azimuth_moment += static_cast<double>(layer(row, beam)) * (150 - beam);
    }
  }
  EXPECT_LT(before, 1e-3 * sum_of(layer));
  EXPECT_NEAR(azimuth_moment / sum_of(layer), 0.0, 1.0);
}

}  // namespace
}  // namespace ensonify
