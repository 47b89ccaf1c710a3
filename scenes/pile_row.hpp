#pragma once

#include "ensonify/config/distribution.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// A row of piles along +x of the object frame. The head of the first is the origin; piles hang down from z = 0.
struct PileRow {
  int piles = 1;
  double spacing_m = 2;
  double length_m = 8;
  bool h_beam = false;                     ///< rolled steel with its flanges across the row, instead of round
  Distribution radius_m = Constant{0.15};  ///< each pile its own; half the width of an H
  Distribution tilt_deg = Constant{0};     ///< degrees from the vertical, towards a random azimuth
  Distribution offset_m = Constant{0};     ///< of the head from its place in the row, along x and y
};

/// Piles are scaled instances of one mesh.
Assembly build_pile_row(const PileRow& row, RandomKey key);

}  // namespace ensonify
