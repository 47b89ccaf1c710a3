#pragma once

#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/strewing.hpp"

namespace ensonify {

enum class DebrisKind { box, plank, tube, tyre, slab, boulder };

/// What people and storms leave on the bottom, strewn over an area of the object frame.
struct DebrisScatter {
  int pieces = 20;
  StrewnArea where;
  std::vector<DebrisKind> kinds;            ///< all alike likely
  Distribution size_m = Uniform{0.3, 1.2};  ///< longest side of a piece
  double burial = 0.2;                      ///< share of a piece's height that is under ground
  double tilt_rad = 0.2;                    ///< greatest lean; tubes and boulders lie as they fell
};

/// Instances of a few variants of each kind, lowest point under the ground by the burial.
Assembly scatter_debris(const DebrisScatter& scatter, const ScatterGround& ground, RandomKey key);

}  // namespace ensonify
