#pragma once

#include "ensonify/config/distribution.hpp"
#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/strewing.hpp"

namespace ensonify {

/// Closed stone about the origin: an icosphere made oblong (`flatness` 0 round .. 0.8) and bumpy by gradient noise.
/// `roughness` is the relative depth of the bumps. 20 * 4^detail triangles, mean radius about `radius_m`.
TriangleMesh make_boulder(double radius_m, double roughness, double flatness, int detail, RandomKey key);

/// Stones strewn over an area of the object frame.
struct BoulderScatter {
  int boulders = 10;
  StrewnArea where;
  Distribution radius_m = Constant{0.3};
  double roughness = 0.25;
  double flatness = 0.35;
  double burial = 0.2;  ///< share of the radius that is under ground
  int variants = 6;     ///< different stones; the others are turned and scaled instances
  int detail = 3;
};

Assembly scatter_boulders(const BoulderScatter& scatter, const ScatterGround& ground, RandomKey key);

}  // namespace ensonify
