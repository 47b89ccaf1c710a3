#pragma once

#include "ensonify/scenes/boulders.hpp"

namespace ensonify {

/// Breakwater: a core of trapezoid section along x of the object frame, armoured with loose rocks.
/// The origin is the middle of the crest of the core; the base lies `height_m` below.
struct RubbleMound {
  double length_m = 20;
  double crest_width_m = 2;
  double height_m = 5;
  double slope_rad = 0.6;  ///< of both sides, from the horizontal
  bool one_sided = false;  ///< rocks on the slope towards -y only
  BoulderScatter rocks;    ///< its area is set to the footprint, it overlaps, and it rests on core and seabed
};

/// Height (m) of the core in the object frame; below the base outside the footprint.
double mound_height_m(const RubbleMound& mound, double x_m, double y_m);

/// The closed core and the rocks on it.
Assembly build_rubble_mound(const RubbleMound& mound, const ScatterGround& ground, RandomKey key);

}  // namespace ensonify
