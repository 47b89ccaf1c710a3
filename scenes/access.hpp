#pragma once

#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// Solid flight that climbs along +x from the origin, its width about y = 0. Volume: width rise run steps (steps + 1)
/// / 2.
struct Stairs {
  int steps = 10;
  double rise_m = 0.17;
  double run_m = 0.29;
  double width_m = 1.2;
};
TriangleMesh make_stairs(const Stairs& stairs);

/// Two stiles from z = 0 to the height, at y = +-width / 2, with rungs between.
struct Ladder {
  double height_m = 4;
  double width_m = 0.45;
  double rung_spacing_m = 0.3;
  double stile_radius_m = 0.03;
  double rung_radius_m = 0.015;
};
Assembly build_ladder(const Ladder& ladder);

}  // namespace ensonify
