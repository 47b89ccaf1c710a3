#include "ensonify/scenes/boulders.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {
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

  Strewer strewer(scatter.where, ground);
  for (int i = 0; i < scatter.boulders; ++i) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(i)));
    const double radius_m = sample(scatter.radius_m, random);
    const int variant = random.below(scatter.variants);
    const Eigen::Quaterniond rotation = random_rotation(random);
    const double reach_m = radius_m * reach[static_cast<std::size_t>(variant)];
    const double lift_m = radius_m * (1.0 - 2.0 * scatter.burial) * 0.8;
    const std::optional<Vec3> centre_m = strewer.place(random, radius_m, reach_m, lift_m);
    if (!centre_m) continue;
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(*centre_m).rotate(rotation).scale(radius_m);
    result.parts.push_back({variant, T});
  }
  return result;
}

}  // namespace ensonify
