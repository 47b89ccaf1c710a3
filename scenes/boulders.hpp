#pragma once

#include <functional>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// Closed stone about the origin: an icosphere made oblong (`flatness` 0 round .. 0.8) and bumpy by gradient noise.
/// `roughness` is the relative depth of the bumps. 20 * 4^detail triangles, mean radius about `radius_m`.
TriangleMesh make_boulder(double radius_m, double roughness, double flatness, int detail, RandomKey key);

/// Stones strewn over an area of the object frame.
struct BoulderScatter {
  int boulders = 10;
  Eigen::AlignedBox2d area_m;
  Distribution radius_m = Constant{0.3};
  double roughness = 0.25;
  double flatness = 0.35;
  double burial = 0.2;  ///< share of the radius that is under ground
  int variants = 6;     ///< different stones; the others are turned and scaled instances
  int detail = 3;
  bool overlap = false;           ///< false: a stone finds a place of its own, or is left out after 40 tries
  double path_clearance_m = 0.8;  ///< free water to keep about the path
};

/// Ground height (m) and the path to keep clear, both in the object frame.
struct ScatterGround {
  std::function<double(double x_m, double y_m)> height_m;
  std::vector<Vec3> path_m;
};

Assembly scatter_boulders(const BoulderScatter& scatter, const ScatterGround& ground, RandomKey key);

/// Distance (m) of a point from a polyline; infinite for an empty one.
double distance_to_path_m(const Vec3& p, const std::vector<Vec3>& path_m);

}  // namespace ensonify
