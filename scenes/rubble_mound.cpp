#include "ensonify/scenes/rubble_mound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ensonify/scenes/basic_shapes.hpp"

namespace ensonify {
namespace {

double foot_width_m(const RubbleMound& mound) { return mound.height_m / std::tan(mound.slope_rad); }

TriangleMesh core_mesh(const RubbleMound& mound) {
  TriangleMesh mesh = make_box({mound.length_m, 2.0, mound.height_m});
  for (Eigen::Vector3f& v : mesh.vertices_m) {
    const double half_width_m = 0.5 * mound.crest_width_m + (v.z() < 0 ? foot_width_m(mound) : 0.0);
    v.y() = static_cast<float>(v.y() * half_width_m);
    v.z() -= static_cast<float>(0.5 * mound.height_m);
  }
  return mesh;
}

}  // namespace

double mound_height_m(const RubbleMound& mound, double x_m, double y_m) {
  const double beyond_crest_m = std::abs(y_m) - 0.5 * mound.crest_width_m;
  if (std::abs(x_m) > 0.5 * mound.length_m || beyond_crest_m > foot_width_m(mound)) {
    return -std::numeric_limits<double>::infinity();
  }
  return -std::max(0.0, beyond_crest_m) * std::tan(mound.slope_rad);
}

Assembly build_rubble_mound(const RubbleMound& mound, const ScatterGround& ground, RandomKey key) {
  BoulderScatter rocks = mound.rocks;
  rocks.where.overlap = true;
  const double toe_m = 0.5 * mound.crest_width_m + foot_width_m(mound) + 0.5;
  rocks.where.area_m =
      Eigen::AlignedBox2d(Eigen::Vector2d(-0.5 * mound.length_m, -toe_m),
                          Eigen::Vector2d(0.5 * mound.length_m, mound.one_sided ? 0.5 * mound.crest_width_m : toe_m));
  const ScatterGround top{
      [&](double x_m, double y_m) { return std::max(mound_height_m(mound, x_m, y_m), ground.height_m(x_m, y_m)); },
      ground.path_m};
  Assembly result = scatter_boulders(rocks, top, key);
  result.parts.push_back({static_cast<int>(result.meshes.size()), Eigen::Affine3d::Identity()});
  result.meshes.push_back(core_mesh(mound));
  return result;
}

}  // namespace ensonify
