// Absolute level of multipath against closed forms and numerical integration that share no code with the tracer.
//   C = int int  sigma_A / cos_A  sigma_B / cos_B  d^-2  dOmega_A dOmega_B,   dOmega = dA cos / r^2,
// over ordered pairs of places: every path is travelled in both directions.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/sim/path_pair.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

SonarModel wide_sonar() { return bare_sonar({.beams = 200, .azimuth_fov_deg = 60.0, .bins = 400}); }

Image2<float> multipath_of(const Scene& scene, const SonarModel& sonar, int order = 2, double samples = 1.0) {
  const RayScene rays(scene);
  return MultipathTracer(rays, sonar, scene.water).trace(Pose::Identity(), order, samples);
}

// Inside a Lambert sphere of radius R around the sonar. What falls on a wall element from any other is the same
// wherever it lies (cos cos' / d^2 = 1 / (4 R^2)), so a fan of solid angle Omega of unit intensity makes the irradiance
// rho Omega / (4 pi R^2) everywhere, rho = pi mu, and each further surface multiplies by rho. Back at the sonar,
// dOmega of wall of irradiance E gives mu E dOmega:
//   order 2: (rho Omega)^2 / (4 pi^2 R^2),   order 3: rho times that.
// Omega = 2 sin(10 deg) * 60 deg. This also is the largest that energy allows: nothing is lost.
TEST(MultipathLevel, InsideOfALambertSphere) {
  const double radius = 2.0;
  const double rho = std::numbers::pi * test_mu;
  const double omega = 2.0 * std::sin(radians(10.0)) * radians(60.0);
  const Scene scene = scene_of({sphere_mesh(radius, 192, 96)});
  const double expected = std::pow(rho * omega / (2.0 * std::numbers::pi * radius), 2);
  const double second = sum_of(multipath_of(scene, wide_sonar()));
  EXPECT_NEAR(second / expected, 1.0, 0.01);
  // One walk in thirty ends in the fan, so of order 3 a default ping finds some 500 paths, and one of 64 times the
  // samples eight times as many: standard deviations of 3.5 and 1.4 %.
  const double third = sum_of(multipath_of(scene, wide_sonar(), 3)) - second;
  EXPECT_NEAR(third / (rho * expected), 1.0, 0.12);
  const double many =
      sum_of(multipath_of(scene, wide_sonar(), 3, 64)) - sum_of(multipath_of(scene, wide_sonar(), 2, 64));
  EXPECT_NEAR(many / (rho * expected), 1.0, 0.045);
}

// The same of a wide fan: a chord between two places near its upper border rises beyond the border and comes back.
TEST(MultipathLevel, InsideOfALambertSphereAcrossAWideFan) {
  const double radius = 2.0;
  const double rho = std::numbers::pi * test_mu;
  const double omega = 2.0 * std::sin(radians(20.0)) * radians(130.0);
  const Scene scene = scene_of({sphere_mesh(radius, 192, 96)});
  const SonarModel sonar = bare_sonar({.beams = 200, .azimuth_fov_deg = 130.0, .elevation_fov_deg = 40.0, .bins = 400});
  const double expected = std::pow(rho * omega / (2.0 * std::numbers::pi * radius), 2);
  EXPECT_NEAR(sum_of(multipath_of(scene, sonar)) / expected, 1.0, 0.01);
}

// In a closed box the walls' irradiance is not even, but its sum is what the first surfaces pass on, rho Omega, and the
// sonar receives mu E cos / r^2 dA <= mu E dA / r_min^2 of an element: at most rho^2 Omega / (pi r_min^2), and rho
// times that for a third surface.
TEST(MultipathLevel, AClosedBoxSendsNoMoreThanItsReflectivitiesAllow) {
  for (const double lambert_db : {-5.2, -10.0, -20.0}) {
    Scene scene = scene_of({box_mesh({-1.5F, -1.0F, -0.8F}, {2.0F, 1.2F, 1.1F})});
    scene.materials[0].lambert_db = lambert_db;
    const double rho = std::numbers::pi * std::pow(10.0, 0.1 * lambert_db);
    const double omega = 2.0 * std::sin(radians(10.0)) * radians(60.0);
    const double bound = rho * rho * omega / (std::numbers::pi * 0.8 * 0.8);
    const double second = sum_of(multipath_of(scene, wide_sonar()));
    const double third = sum_of(multipath_of(scene, wide_sonar(), 3)) - second;
    EXPECT_GT(second, 0.0);
    EXPECT_LT(second, bound);
    EXPECT_LT(third, rho * bound);
  }
}

struct Patch {
  Vec3 centre, half_u, half_v;
  Vec3 normal() const { return half_u.cross(half_v).normalized(); }
  double area() const { return 4.0 * half_u.norm() * half_v.norm(); }
  Vec3 at(double u, double v) const { return centre + u * half_u + v * half_v; }
};

/// The integral above by the midpoint rule; the two grids differ, so that no two midpoints coincide.
double integrated(const Patch& a, const Patch& b, const Material& of_a, const Material& of_b, int steps) {
  const auto sigma = [](const Material& m, const Vec3& n, const Vec3& i, const Vec3& o) {
    const Vec3 h = (i + o).normalized();
    const double masking = std::min({1.0, 2.0 * n.dot(h) * n.dot(i) / i.dot(h), 2.0 * n.dot(h) * n.dot(o) / i.dot(h)});
    return std::pow(10.0, 0.1 * m.lambert_db) * n.dot(i) * n.dot(o) +
           std::pow(10.0, 0.1 * m.specular_db) * std::pow(n.dot(h), m.specular_exponent) * masking;
  };
  const auto midpoint = [](int i, int n) { return (2.0 * i + 1.0) / n - 1.0; };
  const int fine = steps + 3;
  double sum = 0.0;
  for (int i = 0; i < steps * steps; ++i) {
    const Vec3 p = a.at(midpoint(i % steps, steps), midpoint(i / steps, steps));
    for (int j = 0; j < fine * fine; ++j) {
      const Vec3 q = b.at(midpoint(j % fine, fine), midpoint(j / fine, fine));
      const Vec3 e = (q - p).normalized();
      sum += sigma(of_a, a.normal(), -p.normalized(), e) * sigma(of_b, b.normal(), -q.normalized(), -e) /
             (p.squaredNorm() * q.squaredNorm() * (q - p).squaredNorm());
    }
  }
  return 2.0 * sum * a.area() * b.area() / (1.0 * steps * steps * fine * fine);
}

Scene two_patches(const Patch& a, const Patch& b, const Material& of_a, const Material& of_b) {
  Scene scene = scene_of({plate_mesh(a.centre, a.half_u, a.half_v), plate_mesh(b.centre, b.half_u, b.half_v)});
  scene.materials = {of_a, of_b};
  scene.instances[1].material = 1;
  return scene;
}

const Material lambert{"lambert", -10.0, -300.0, 50.0, "test"};
const Material concrete{"concrete", -18.0, -3.4, 25.0, "test"};
const Material steel{"steel", -30.0, 11.5, 400.0, "test"};

// Two perpendicular patches a metre apart, and the same two meeting in an edge, where d^-2 has its pole.
TEST(MultipathLevel, PerpendicularPatches) {
  const Vec3 left = Vec3(-1, -1, 0).normalized();  // normal of the patch to port
  const Vec3 right = Vec3(-1, 1, 0).normalized();
  for (const double gap : {0.0, 0.5}) {
    const auto patch = [&](const Vec3& normal) {
      const Vec3 along = Vec3::UnitZ().cross(normal);
      const Vec3 outwards = (along.x() > 0.0 ? -along : along).normalized();  // away from the edge, towards the sonar
      const Vec3 v = 0.25 * Vec3::UnitZ();
      Patch p{Vec3(4, 0, 0) + (gap + 0.3) * outwards, 0.3 * outwards, v};
      if (p.normal().dot(normal) < 0.0) p.half_v = -p.half_v;
      return p;
    };
    const Patch a = patch(left);
    const Patch b = patch(right);
    for (const auto& [of_a, of_b] :
         {std::pair(lambert, lambert), std::pair(concrete, lambert), std::pair(steel, concrete)}) {
      // Next to an edge the sharp lobe of steel is too much for the midpoint rule.
      if (gap == 0.0 && of_a.specular_exponent > 100.0) continue;
      const double expected = integrated(a, b, of_a, of_b, 32);
      const double traced = sum_of(multipath_of(two_patches(a, b, of_a, of_b), wide_sonar()));
      EXPECT_NEAR(traced / expected, 1.0, 0.04) << of_a.name << " and " << of_b.name << ", gap " << gap;
    }
  }
}

// Swapping source and receiver: what a pair of places carries from A to B it carries from B to A. The tracer's sum
// treats its two places differently (a packet and a lane; who walks, who is found), so nothing but physics makes them
// agree.
TEST(MultipathLevel, PairsAreReciprocal) {
  PathPoints a;
  PathPoints b;
  for (int l = 0; l < packet_lanes; ++l) {
    clear_point(a, l);
    clear_point(b, l);
    const auto place = [&](PathPoints& p, double r, double azimuth, const Vec3& normal, const Material& material) {
      const Vec3 d(std::cos(azimuth), std::sin(azimuth), 0.02 * l);
      const Vec3 unit = d.normalized();
      const Vec3 n = normal.normalized();
      const SurfaceLaw law = surface_law(material);
      const auto f = [](double x) { return static_cast<float>(x); };
      p.x[l] = f(r * unit.x()), p.y[l] = f(r * unit.y()), p.z[l] = f(r * unit.z());
      p.dx[l] = f(unit.x()), p.dy[l] = f(unit.y()), p.dz[l] = f(unit.z());
      p.nx[l] = f(n.x()), p.ny[l] = f(n.y()), p.nz[l] = f(n.z());
      p.range_m[l] = f(r), p.cos_sonar[l] = f(-n.dot(unit));
      p.send[l] = f(1.0 + 0.1 * l), p.density[l] = f(100.0 * (l + 1.0));
      p.mu[l] = law.mu, p.specular[l] = law.specular, p.exponent[l] = law.exponent, p.lobe_share[l] = law.lobe_share;
    };
    place(a, 3.0 + 0.1 * l, 0.3, {-1, -1, 0.1}, l % 2 ? steel : concrete);
    place(b, 4.0, -0.2 - 0.02 * l, {-1, 1, 0.05 * l}, l % 3 ? concrete : lambert);
  }
  for (int i = 0; i < packet_lanes; ++i) {
    for (int j = 0; j < packet_lanes; ++j) {
      const PathPair there = path_pair(a, i, b, j);
      const PathPair back = path_pair(b, j, a, i);
      ASSERT_GT(there.energy, 0.0f);
      EXPECT_NEAR(there.energy / back.energy, 1.0f, 1e-4f);
      EXPECT_FLOAT_EQ(there.half_length_m, back.half_length_m);
    }
  }
}

// The same in a scene: sonar - A - B - sonar arrives from B, sonar - B - A - sonar from A, in the same time. A mirror
// and a rock, of different size and distance: the two halves of the fan receive the same energy, bin by bin.
TEST(MultipathLevel, BothDirectionsOfTravelArrive) {
  const Patch a{{3.0, 0.7, 0.0}, 0.25 * Vec3(0.8, -0.6, 0), 0.2 * Vec3::UnitZ()};
  const Patch b{{3.6, -0.9, 0.0}, 0.5 * Vec3(-0.8, -0.6, 0), 0.35 * Vec3::UnitZ()};
  const Image2<float> layer = multipath_of(two_patches(a, b, steel, concrete), wide_sonar());
  double port = 0.0;
  double starboard = 0.0;
  for (int bin = 0; bin < layer.rows(); ++bin) {
    for (int beam = 0; beam < layer.columns(); ++beam)
      (beam < 100 ? port : starboard) += static_cast<double>(layer(bin, beam));
  }
  ASSERT_GT(port, 0.0);
  EXPECT_NEAR(port / starboard, 1.0, 0.01);
}

}  // namespace
}  // namespace ensonify
