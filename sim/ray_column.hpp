#pragma once

#include <Eigen/Core>
#include <vector>

#include "ensonify/sim/ray_fan.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

/// The elevation rays of one column and what they met; arrays over the rays.
/// `range_m` is +inf for a miss and padded by one miss on either side: ray i is range_m[i + 1].
struct RayColumn {
  explicit RayColumn(int rays);

  int rays;
  std::vector<float> range_m;
  std::vector<float> normal_forward;  ///< n . h, h = horizontal direction of the column; n not normalised
  std::vector<float> normal_up;       ///< n . z of the sonar
  std::vector<float> normal_left;     ///< n . dh/dtheta
  std::vector<float> inverse_norm;    ///< 1 / |n|
  std::vector<int> surface;           ///< index into RayScene::surfaces, 0 for a miss

  std::vector<int> material;  ///< of that surface

  // Shaded:
  std::vector<float> slant;   ///< n . d, n not normalised
  std::vector<float> energy;  ///< without r^-2 and absorption; 0 for a miss
  std::vector<float> cos_incidence;
  std::vector<float> near_m, far_m;  ///< ranges that the ray's footprint covers
  std::vector<float> slope;          ///< change of the energy's density from near to far, over its mean
};

/// The axes of the sonar frame in the world, single precision.
struct RayAxes {
  Eigen::Vector3f origin, forward, left, up;
};

/// Casts the rays of one column up to `reach_m`.
void cast_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, const RayAxes& axes,
                 float reach_m, RayColumn& rays);

/// Energy and footprint of every ray of a cast column.
void shade_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, RayColumn& rays);

}  // namespace ensonify
