#pragma once

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// A lorry's or a car's tyre without its rim: hollow, open towards the rim, two rows of staggered tread blocks.
/// Axis z, about its centre.
struct Tyre {
  double outer_radius_m = 0.5;
  double width_m = 0.28;
  double rim_radius_m = 0.28;
  int blocks = 28;  ///< around, in each row; 0: smooth
};

TriangleMesh make_tyre(const Tyre& tyre);

}  // namespace ensonify
