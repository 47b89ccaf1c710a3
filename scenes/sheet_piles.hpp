#pragma once

#include "ensonify/config/distribution.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// A wall of interlocked sheet piles along +x of the object frame, from the origin; the heads are at z = 0, the middle
/// of the corrugation at y = 0.
struct SheetPileWall {
  double length_m = 20;
  double height_m = 8;
  double depth_m = 0.4;                 ///< of the corrugation, outside to outside
  double pitch_m = 0.6;                 ///< width of one pile
  double thickness_m = 0.02;            ///< of the steel
  bool z_profile = false;               ///< interlocks in the flanges (Z) instead of on the middle line (U)
  Distribution offset_m = Constant{0};  ///< of each pile from its place, along y and z
  double cap_height_m = 0;              ///< beam along the heads; 0: none
  double cap_width_m = 0.8;
};

/// Piles in the wall: as many as begin within its length.
int sheet_piles(const SheetPileWall& wall);

/// Instances of one pile, every second one turned over, and the cap.
Assembly build_sheet_pile_wall(const SheetPileWall& wall, RandomKey key);

}  // namespace ensonify
