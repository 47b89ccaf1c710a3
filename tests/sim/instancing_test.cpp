// Above 200000 triangles in all, a mesh used more than once stays one Embree instance each; below, it is copied.
#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

/// Uses of one mesh, rotated and scaled by other numbers on every axis.
std::vector<Eigen::Affine3d> places(int count) {
  std::vector<Eigen::Affine3d> all;
  for (int i = 0; i < count; ++i) {
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(Vec3(3.0 + 0.7 * i, 0.4 * (i - 1), 0.1 * i - 0.2));
    T.rotate(Eigen::AngleAxisd(0.6 + i, Vec3(1, 2, 3).normalized()));
    T.scale(Vec3(0.6, 0.2, 0.35));
    all.push_back(T);
  }
  return all;
}

/// Many uses of one mesh (instanced where heavy), or one mesh for each use (copied).
Scene scene_with(const TriangleMesh& mesh, const std::vector<Eigen::Affine3d>& at, bool shared) {
  Scene scene = scene_of(std::vector<TriangleMesh>(shared ? 1 : at.size(), mesh));
  scene.instances.resize(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    scene.instances[i].mesh = shared ? 0 : static_cast<int>(i);
    scene.instances[i].T_world_object = at[i];
  }
  return scene;
}

TEST(Instancing, SameImageAsCopies) {
  const TriangleMesh heavy = sphere_mesh(1.0, 400, 101);  // 80000 triangles, three times
  const Scene instanced = scene_with(heavy, places(3), true);
  const Scene copied = scene_with(heavy, places(3), false);
  ASSERT_TRUE(RayScene(instanced).surfaces()[0].instanced);
  ASSERT_FALSE(RayScene(copied).surfaces()[0].instanced);
  const SonarModel sonar = bare_sonar({.elevation_rays = 512});
  const Ping a = ping_of(instanced, sonar, Pose::Identity(), true);
  const Ping b = ping_of(copied, sonar, Pose::Identity(), true);
  double difference = 0;
  for (std::size_t i = 0; i < a.echo.direct.size(); ++i) {
    difference += std::abs(static_cast<double>(a.echo.direct.pixels()[i] - b.echo.direct.pixels()[i]));
  }
  EXPECT_LT(difference, 2e-3 * sum_of(b.echo.direct));  // rays at a facet's edge may meet its neighbour
  EXPECT_NEAR(sum_of(a.echo.direct) / sum_of(b.echo.direct), 1.0, 1e-4);
  int other = 0;
  for (std::size_t i = 0; i < a.truth.instance.size(); ++i) {
    other += a.truth.instance.pixels()[i] != b.truth.instance.pixels()[i];
  }
  EXPECT_LT(other, 5);
}

// Normals map by the inverse transpose. A plate in the plane x + z = 0 of its own frame, drawn out by (1, 1, 3), lies
// in z = -3 x: its normal (3, 0, 1) / sqrt(10) meets the x axis at cos i = 3 / sqrt(10), 18.4 deg, where the unscaled
// normal would say 45 deg and a normal scaled like a point 71.6 deg.
TEST(Instancing, ScaledNormals) {
  TriangleMesh plate;
  const int n = 320;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double s = 2.0 * i / n - 1.0;
      plate.vertices_m.push_back(Vec3(s, 2.0 * j / n - 1.0, -s).cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t v = i * (n + 1) + j;
      plate.triangles.push_back({v, v + n + 1, v + n + 2});
      plate.triangles.push_back({v, v + n + 2, v + 1});
    }
  }
  Eigen::Affine3d T = Eigen::Affine3d::Identity();
  T.translate(Vec3(4, 0, 0)).scale(Vec3(1, 1, 3));
  Eigen::Affine3d away = Eigen::Affine3d::Identity();
  away.translate(Vec3(-50, 0, 0));
  const Scene scene = scene_with(plate, {T, away}, true);
  ASSERT_TRUE(RayScene(scene).surfaces()[0].instanced);
  const SonarModel sonar = bare_sonar({.azimuth_fov_deg = 4.0, .elevation_fov_deg = 2.0});
  const Ping ping = ping_of(scene, sonar, Pose::Identity(), true);
  const auto bin = sonar.geometry.bin_of(4.0);
  EXPECT_NEAR(degrees(ping.truth.incidence_rad(*bin, 64)), degrees(std::acos(3.0 / std::sqrt(10.0))), 1.1);
}

}  // namespace
}  // namespace ensonify
