// What every bundled place must keep, in the layouts that the bundled recipes use most.

#include "ensonify/config/library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "ensonify/scenes/boulders.hpp"
#include "ensonify/scenes/material_library.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify {
namespace {

constexpr std::uint64_t layouts = 4;

class BundledPlace : public ::testing::TestWithParam<std::string> {};

std::vector<Vec3> path_of(const Scene& scene) {
  std::vector<Vec3> path;
  for (const Pose& waypoint : scene.waypoints) path.push_back(waypoint.translation());
  return path;
}

double path_length_m(const std::vector<Vec3>& path_m) {
  double length = 0;
  for (std::size_t i = 1; i < path_m.size(); ++i) length += (path_m[i] - path_m[i - 1]).norm();
  return length;
}

/// Calls visit(instance, p_world) for points of all obstacles, at most `step_m` apart.
template <typename Visit>
void for_points_on_obstacles(const Scene& scene, double step_m, const Visit& visit) {
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    std::vector<Vec3> vertices;
    for (const Eigen::Vector3f& v : mesh.vertices_m) vertices.push_back(instance.T_world_object * v.cast<double>());
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 ab = vertices[b] - vertices[a], ac = vertices[c] - vertices[a];
      const int nu = static_cast<int>(std::ceil(ab.norm() / step_m)),
                nv = static_cast<int>(std::ceil(ac.norm() / step_m));
      for (int u = 0; u <= nu; ++u) {
        for (int v = 0; u * nv + v * nu <= nu * nv; ++v) {
          visit(instance, vertices[a] + ab * u / std::max(nu, 1) + ac * v / std::max(nv, 1));
        }
      }
    }
  }
}

TEST_P(BundledPlace, LoadsAndVariesByLayout) {
  std::set<std::vector<float>> seen;
  for (std::uint64_t layout = 0; layout < layouts; ++layout) {
    const Scene scene = load_scene(GetParam(), layout);
    EXPECT_TRUE(scene.warnings.empty());
    std::vector<float> bits;
    for (const Instance& instance : scene.instances) {
      for (const double x : instance.T_world_object.matrix().reshaped()) bits.push_back(static_cast<float>(x));
      for (const auto& v : scene.meshes[static_cast<std::size_t>(instance.mesh)].vertices_m) bits.push_back(v.z());
    }
    EXPECT_TRUE(seen.insert(bits).second) << "layout " << layout << " repeats another";
  }
  EXPECT_EQ(load_scene(GetParam(), 2).instances.size(), load_scene(GetParam(), 2).instances.size());
}

TEST_P(BundledPlace, HasWatertightObstacles) {
  const Scene scene = load_scene(GetParam(), 1);
  for (const Instance& instance : scene.instances) {
    if (!instance.obstacle) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    EXPECT_EQ(unpaired_edges(mesh), 0u) << instance.name;
    EXPECT_GT(enclosed_volume_m3(mesh), 0) << instance.name;
    EXPECT_GT(instance.T_world_object.linear().determinant(), 0) << instance.name;
  }
}

TEST_P(BundledPlace, KeepsItsPathClear) {
  for (std::uint64_t layout = 0; layout < layouts; ++layout) {
    const Scene scene = load_scene(GetParam(), layout);
    const std::vector<Vec3> path_m = path_of(scene);
    EXPECT_GE(path_length_m(path_m), GetParam() == "breakwater" ? 55 : 27);
    Eigen::AlignedBox3d near_path;
    for (const Vec3& p : path_m) near_path.extend(p);
    near_path = {near_path.min() - Vec3::Ones(), near_path.max() + Vec3::Ones()};
    double clearance_m = 99;
    std::string nearest;
    for_points_on_obstacles(scene, 0.15, [&](const Instance& instance, const Vec3& p) {
      const double distance_m = near_path.contains(p) ? distance_to_path_m(p, path_m) : clearance_m;
      if (distance_m >= clearance_m) return;
      clearance_m = distance_m;
      nearest = instance.name;
    });
    EXPECT_GE(clearance_m, 0.5) << nearest << ", layout " << layout;
  }
}

/// Share of the path from which at least a quarter of a 60 x 12 degree fan of 5 m range meets an obstacle.
TEST_P(BundledPlace, ShowsSomethingMostOfTheTime) {
  const Scene scene = load_scene(GetParam(), 0);
  std::vector<Pose> sonars;
  for (std::size_t i = 1; i < scene.waypoints.size(); ++i) {
    const Pose &from = scene.waypoints[i - 1], &to = scene.waypoints[i];
    const Eigen::Quaterniond q(from.rotation()), r(to.rotation());
    for (const double t : {0.0, 0.25, 0.5, 0.75}) {
      Pose sonar = Pose::Identity();
      sonar.linear() = q.slerp(t, r).toRotationMatrix();
      sonar.translation() = (1 - t) * from.translation() + t * to.translation();
      sonars.push_back(sonar.inverse());
    }
  }
  constexpr int beams = 16;
  std::vector<std::uint32_t> met(sonars.size());
  for_points_on_obstacles(scene, 0.3, [&](const Instance&, const Vec3& p_world) {
    for (std::size_t i = 0; i < sonars.size(); ++i) {
      const Vec3 p = sonars[i] * p_world;
      if (p.x() < 0 || p.squaredNorm() > 25 || std::abs(p.z()) > std::tan(radians(6)) * p.head<2>().norm()) continue;
      const double across = degrees(std::atan2(p.y(), p.x())) / 30;
      if (std::abs(across) < 1) met[i] |= 1u << static_cast<int>((across + 1) * 0.5 * beams);
    }
  });
  const auto shows =
      std::count_if(met.begin(), met.end(), [](std::uint32_t m) { return std::popcount(m) >= beams / 4; });
  EXPECT_GE(static_cast<double>(shows), 0.6 * static_cast<double>(met.size()));
}

INSTANTIATE_TEST_SUITE_P(Library, BundledPlace, ::testing::ValuesIn(library_names("scenes")),
                         [](const auto& test) { return test.param; });

TEST(Library, HoldsTheTwelvePlaces) {
  EXPECT_EQ(
      library_names("scenes"),
      (std::vector<std::string>{"artificial_reef", "boulder_field", "breakwater", "canal", "dam", "ferry_berth",
                                "marina", "offshore_jacket", "open_water", "pier_harbor", "pipeline", "test_tank"}));
}

TEST(Library, MaterialsSayWhereTheyComeFrom) {
  const std::vector<Material> materials = bundled_materials();
  EXPECT_GE(materials.size(), 13u);
  for (const Material& material : materials) {
    EXPECT_FALSE(material.source.empty()) << material.name;
    EXPECT_GE(material.specular_exponent, 2) << material.name;
    EXPECT_LT(backscatter(material, 0.5), 1) << material.name;
  }
}

}  // namespace
}  // namespace ensonify
