#include "ensonify/scenes/loft.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/mesh_weld.hpp"

namespace ensonify {
namespace {

using Index = std::uint32_t;

TriangleMesh skin(const std::vector<Ring>& rings, bool loop) {
  const Index n = static_cast<Index>(rings.front().size()), count = static_cast<Index>(rings.size());
  TriangleMesh mesh;
  for (const Ring& ring : rings) {
    for (const Vec3& p : ring) mesh.vertices_m.push_back(p.cast<float>());
  }
  for (Index r = 0; r + 1 < count + (loop ? 1u : 0u); ++r) {
    const Index here = r * n, next = (r + 1) % count * n;
    for (Index i = 0; i < n; ++i) {
      const Index j = (i + 1) % n;
      mesh.triangles.push_back({here + i, here + j, next + j});
      mesh.triangles.push_back({here + i, next + j, next + i});
    }
  }
  return mesh;
}

TriangleMesh finished(const TriangleMesh& mesh) {
  TriangleMesh result = weld(mesh).mesh;
  if (enclosed_volume_m3(result) < 0) {
    for (auto& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
  }
  return result;
}

std::vector<Ring> turned(const Polygon& profile, int segments) {
  std::vector<Ring> rings(static_cast<std::size_t>(segments));
  for (int s = 0; s < segments; ++s) {
    const double angle = 2 * std::numbers::pi * s / segments;
    for (const Eigen::Vector2d& p : profile) {
      // Adding 0 makes a negative zero positive, so that points on the axis coincide bit by bit.
      rings[static_cast<std::size_t>(s)].emplace_back(p.x() * std::cos(angle) + 0.0, p.x() * std::sin(angle) + 0.0,
                                                      p.y());
    }
  }
  return rings;
}

}  // namespace

TriangleMesh loft(const std::vector<Ring>& rings, const std::vector<std::array<std::uint32_t, 3>>& cap) {
  TriangleMesh mesh = skin(rings, false);
  const Index last = static_cast<Index>((rings.size() - 1) * rings.front().size());
  for (const auto& [a, b, c] : cap) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({last + a, last + b, last + c});
  }
  return finished(mesh);
}

TriangleMesh loft_loop(const std::vector<Ring>& rings) { return finished(skin(rings, true)); }

std::vector<std::array<std::uint32_t, 3>> fan_cap(std::size_t points) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (Index i = 1; i + 1 < points; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

TriangleMesh extrude(const Polygon& profile, double z_low_m, double z_high_m) {
  Polygon outward = profile;
  if (signed_area(outward) < 0) outward = Polygon(profile.rbegin(), profile.rend());
  std::vector<Ring> rings(2);
  for (const Eigen::Vector2d& p : outward) {
    rings[0].emplace_back(p.x(), p.y(), z_low_m);
    rings[1].emplace_back(p.x(), p.y(), z_high_m);
  }
  return loft(rings, triangulate(outward));
}

TriangleMesh turn_profile(const Polygon& profile, int segments) {
  Polygon closed = profile;
  if (closed.front().x() > 0) closed.insert(closed.begin(), {0, profile.front().y()});
  if (closed.back().x() > 0) closed.emplace_back(0, profile.back().y());
  // The edge along the axis has no area and falls away when its points are joined.
  return loft_loop(turned(closed, segments));
}

TriangleMesh turn_ring_profile(const Polygon& profile, int segments) { return loft_loop(turned(profile, segments)); }

TriangleMesh joined(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const Index first = static_cast<Index>(all.vertices_m.size());
    all.vertices_m.insert(all.vertices_m.end(), mesh.vertices_m.begin(), mesh.vertices_m.end());
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

}  // namespace ensonify
