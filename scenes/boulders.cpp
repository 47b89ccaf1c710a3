#include "ensonify/scenes/boulders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {
namespace {

Eigen::Quaterniond random_rotation(RandomSequence& random) {
  Eigen::Vector4d q;  // four normals point evenly over the unit quaternions
  for (int i = 0; i < 4; ++i) q[i] = random.normal();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

struct Stone {
  Vec3 centre_m;
  double radius_m;
};

}  // namespace

TriangleMesh make_boulder(double radius_m, double roughness, double flatness, int detail, RandomKey key) {
  RandomSequence random(key.child("axes"));
  const Vec3 axes(1.0 + 0.5 * flatness * random.uniform(), 1.0 - 0.5 * flatness * random.uniform(),
                  1.0 - flatness * random.uniform(0.5, 1.0));
  TriangleMesh mesh = make_sphere(1.0, detail);
  for (Eigen::Vector3f& v : mesh.vertices_m) {
    const Vec3 p = v.cast<double>();
    double bump = 0, amplitude = 1, frequency = 1.3;
    for (std::uint64_t octave = 0; octave < 4; ++octave) {
      const Vec3 offset = Vec3::Constant(11.3 + 7.7 * static_cast<double>(octave));
      bump += amplitude * gradient_noise(key.child(octave), frequency * p + offset);
      amplitude *= 0.5;
      frequency *= 2.0;
    }
    const double radius = radius_m * std::max(0.3, 1.0 + 2.0 * roughness * bump);
    v = (radius * axes.cwiseProduct(p)).cast<float>();
  }
  return mesh;
}

double distance_to_path_m(const Vec3& p, const std::vector<Vec3>& path_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    const Vec3& a = path_m[i];
    const Vec3 d = path_m[std::min(i + 1, path_m.size() - 1)] - a;
    const double t = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (p - a - t * d).norm());
  }
  return nearest;
}

Assembly scatter_boulders(const BoulderScatter& scatter, const ScatterGround& ground, RandomKey key) {
  Assembly result;
  std::vector<double> reach;  // of each variant of unit radius
  for (int i = 0; i < scatter.variants; ++i) {
    result.meshes.push_back(make_boulder(1.0, scatter.roughness, scatter.flatness, scatter.detail,
                                         key.child("variant").child(static_cast<std::uint64_t>(i))));
    double farthest = 0;
    for (const Eigen::Vector3f& v : result.meshes.back().vertices_m) farthest = std::max<double>(farthest, v.norm());
    reach.push_back(farthest);
  }

  std::vector<Stone> placed;
  for (int i = 0; i < scatter.boulders; ++i) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(i)));
    const double radius_m = sample(scatter.radius_m, random);
    const int variant = random.below(scatter.variants);
    const Eigen::Quaterniond rotation = random_rotation(random);
    const double reach_m = radius_m * reach[static_cast<std::size_t>(variant)];
    constexpr int tries = 40;
    for (int attempt = 0; attempt < tries; ++attempt) {
      const double x = random.uniform(scatter.area_m.min().x(), scatter.area_m.max().x());
      const double y = random.uniform(scatter.area_m.min().y(), scatter.area_m.max().y());
      const Stone stone{{x, y, ground.height_m(x, y) + radius_m * (1.0 - 2.0 * scatter.burial) * 0.8}, radius_m};
      if (distance_to_path_m(stone.centre_m, ground.path_m) < reach_m + scatter.path_clearance_m) continue;
      const auto collides = [&](const Stone& other) {
        return (other.centre_m - stone.centre_m).norm() < other.radius_m + stone.radius_m;
      };
      if (!scatter.overlap && std::any_of(placed.begin(), placed.end(), collides)) continue;
      placed.push_back(stone);
      Eigen::Affine3d T = Eigen::Affine3d::Identity();
      T.translate(stone.centre_m).rotate(rotation).scale(radius_m);
      result.parts.push_back({variant, T});
      break;
    }
  }
  return result;
}

}  // namespace ensonify
