#pragma once

#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// Screen of upright flat bars in a frame: along x about 0, from z = 0 to the height; flow runs along y.
struct TrashRack {
  double width_m = 3;
  double height_m = 4;
  double bar_spacing_m = 0.1;  ///< centre to centre
  double bar_width_m = 0.015;  ///< across the flow
  double bar_depth_m = 0.06;   ///< along the flow
  double frame_m = 0.12;       ///< width of the frame, inside the outer dimensions
  int cross_bars = 2;
};
Assembly build_trash_rack(const TrashRack& rack);

}  // namespace ensonify
