#include "ensonify/scenes/debris.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/boulders.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/tube.hpp"
#include "ensonify/scenes/tyre.hpp"

namespace ensonify {
namespace {

constexpr int variants = 4;

/// A broken plate of concrete: a many-sided outline, no two sides alike, its top a little smaller than its bottom.
TriangleMesh make_slab(RandomSequence& random) {
  constexpr int corners = 9;
  const double aspect = random.uniform(0.5, 0.9), thickness = random.uniform(0.08, 0.2);
  std::vector<Ring> rings(2);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(-0.3, 0.3)) / corners;
    const double radius = random.uniform(0.38, 0.5);
    const Vec3 p(radius * std::cos(angle), aspect * radius * std::sin(angle), 0);
    rings[0].push_back(p - Vec3(0, 0, 0.5 * thickness));
    rings[1].push_back(random.uniform(0.86, 1.0) * p + Vec3(0, 0, 0.5 * thickness));
  }
  Polygon outline;
  for (const Vec3& p : rings[1]) outline.emplace_back(p.x(), p.y());
  return loft(rings, triangulate(outline));
}

/// A piece whose longest side is about 1.
TriangleMesh make_piece(DebrisKind kind, RandomKey key) {
  RandomSequence random(key);
  switch (kind) {
    case DebrisKind::box:
      return make_box({1, random.uniform(0.5, 0.9), random.uniform(0.3, 0.8)});
    case DebrisKind::plank:
      return make_box({1, random.uniform(0.06, 0.14), random.uniform(0.02, 0.05)});
    case DebrisKind::tube: {
      const double radius = random.uniform(0.06, 0.2);
      return make_hollow_bar({{-0.5, 0, 0}, {0.5, 0, 0}}, radius, 0.86 * radius, 24);
    }
    case DebrisKind::tyre:
      return make_tyre({.outer_radius_m = 0.5, .width_m = random.uniform(0.25, 0.36), .rim_radius_m = 0.28});
    case DebrisKind::slab:
      return make_slab(random);
    case DebrisKind::boulder:
      break;
  }
  return make_boulder(0.45, 0.25, 0.35, 3, key);
}

}  // namespace

Assembly scatter_debris(const DebrisScatter& scatter, const ScatterGround& ground, RandomKey key) {
  Assembly result;
  for (std::size_t kind = 0; kind < scatter.kinds.size(); ++kind) {
    for (std::uint64_t variant = 0; variant < variants; ++variant) {
      const RandomKey own = key.child("variant").child(static_cast<std::uint64_t>(scatter.kinds[kind])).child(variant);
      result.meshes.push_back(make_piece(scatter.kinds[kind], own));
    }
  }
  Strewer strewer(scatter.where, ground);
  for (int i = 0; i < scatter.pieces; ++i) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(i)));
    const int kind = random.below(static_cast<int>(scatter.kinds.size()));
    const int mesh = kind * variants + random.below(variants);
    const double size_m = sample(scatter.size_m, random);
    const double yaw = random.uniform(0, 2 * std::numbers::pi);
    const double roll = scatter.tilt_rad * random.uniform(-1, 1), pitch = scatter.tilt_rad * random.uniform(-1, 1);

    Eigen::Affine3d T(pose_from_xyz_rpy(Vec3::Zero(), roll, pitch, yaw).matrix());
    T.scale(size_m);
    const TriangleMesh& piece = result.meshes[static_cast<std::size_t>(mesh)];
    const Eigen::AlignedBox3d box = bounding_box_m(piece, T);
    double reach_m = 0;
    for (const Eigen::Vector3f& v : piece.vertices_m) reach_m = std::max<double>(reach_m, size_m * v.norm());
    const double lift_m = -box.min().z() - scatter.burial * box.sizes().z();
    const std::optional<Vec3> centre_m = strewer.place(random, 0.8 * reach_m, reach_m, lift_m);
    if (centre_m) result.parts.push_back({mesh, Eigen::Translation3d(*centre_m) * T});
  }
  return result;
}

}  // namespace ensonify
