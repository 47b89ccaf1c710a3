#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/mesh.hpp"

/// Meshes for tests: closed and outward unless the name says otherwise.
namespace ensonify::test {

/// Box from `low` to `high`; 12 triangles, two a face in the order -z +z -y +y -x +x.
inline TriangleMesh box_mesh(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_m.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline TriangleMesh open_box_mesh(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  TriangleMesh mesh = box_mesh(low, high);
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  return mesh;
}

/// Parallelogram about `centre` with half edges u and v; two triangles, the normal along u x v.
inline TriangleMesh plate_mesh(const Vec3& centre, const Vec3& half_u, const Vec3& half_v) {
  TriangleMesh mesh;
  for (const Vec3& p : {Vec3(centre - half_u - half_v), Vec3(centre + half_u - half_v), Vec3(centre + half_u + half_v),
                        Vec3(centre - half_u + half_v)}) {
    mesh.vertices_m.push_back(p.cast<float>());
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Horizontal plane at height z, facing up, reaching `reach_m` in every direction.
inline TriangleMesh floor_mesh(double z_m, double reach_m = 100.0) {
  return plate_mesh({0, 0, z_m}, {reach_m, 0, 0}, {0, reach_m, 0});
}

/// Plane through `point` with normal `n` (horizontal or not), reaching `reach_m`.
inline TriangleMesh wall_mesh(const Vec3& point, const Vec3& n, double reach_m = 100.0) {
  const Vec3 u = n.unitOrthogonal();
  return plate_mesh(point, reach_m * u, reach_m * n.normalized().cross(u));
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Eigen::Vector3f& v : mesh.vertices_m) v += by.cast<float>();
  return mesh;
}

/// Sphere by longitude and latitude around the origin, radius times radius_factor(longitude, latitude).
/// 2 * around * (rings - 1) triangles.
template <typename Factor>
TriangleMesh bumpy_sphere_mesh(double radius_m, int around, int rings, const Factor& radius_factor) {
  TriangleMesh mesh;
  const auto vertex = [&](double longitude, double latitude) {
    const double r = radius_m * radius_factor(longitude, latitude);
    mesh.vertices_m.push_back(Vec3(r * std::cos(latitude) * std::cos(longitude),
                                   r * std::cos(latitude) * std::sin(longitude), r * std::sin(latitude))
                                  .cast<float>());
  };
  vertex(0, -0.5 * std::numbers::pi);
  for (int ring = 1; ring < rings; ++ring) {
    for (int i = 0; i < around; ++i)
      vertex(2 * std::numbers::pi * i / around, std::numbers::pi * ring / rings - 0.5 * std::numbers::pi);
  }
  vertex(0, 0.5 * std::numbers::pi);
  const auto at = [&](int ring, int i) { return static_cast<std::uint32_t>(1 + (ring - 1) * around + i % around); };
  const std::uint32_t top = static_cast<std::uint32_t>(mesh.vertices_m.size() - 1);
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      mesh.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    mesh.triangles.push_back({at(rings - 1, i), at(rings - 1, i + 1), top});
  }
  return mesh;
}

inline TriangleMesh sphere_mesh(double radius_m, int around = 96, int rings = 48) {
  return bumpy_sphere_mesh(radius_m, around, rings, [](double, double) { return 1.0; });
}

/// Upper half of a sphere, open below.
inline TriangleMesh hemisphere_mesh(double radius_m, int around = 96, int rings = 48) {
  TriangleMesh mesh = sphere_mesh(radius_m, around, rings);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return std::min({mesh.vertices_m[t[0]].z(), mesh.vertices_m[t[1]].z(), mesh.vertices_m[t[2]].z()}) <
           -1e-3F * static_cast<float>(radius_m);
  });
  return mesh;
}

/// Ring in the plane z = 0.
inline TriangleMesh torus_mesh(double ring_radius_m, double tube_radius_m, int around = 192, int across = 96) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around;
      const double b = 2 * std::numbers::pi * j / across;
      const double r = ring_radius_m + tube_radius_m * std::cos(b);
      mesh.vertices_m.push_back(Vec3(r * std::cos(a), r * std::sin(a), tube_radius_m * std::sin(b)).cast<float>());
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Volume of a closed mesh by the divergence theorem.
inline double volume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_m[t[0]].cast<double>();
    six_volumes += a.dot(mesh.vertices_m[t[1]].cast<double>().cross(mesh.vertices_m[t[2]].cast<double>()));
  }
  return six_volumes / 6;
}

}  // namespace ensonify::test
