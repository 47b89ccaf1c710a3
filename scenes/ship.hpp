#pragma once

#include "ensonify/core/random.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// A cargo ship, bow to +x, amidships at x = 0, z = 0 at its waterline. The lines are invented, of the kind that
/// freighters of the last century had; no seagoing qualities are claimed.
struct Ship {
  double length_m = 90;
  double beam_m = 13.5;
  double depth_m = 7.6;  ///< keel to deck
  double draft_m = 5;
  double bilge_radius_m = 1.6;
  bool bulb = true;
  int hatches = 4;
  int masts = 2;
  enum class House { none, aft, middle } house = House::aft;
  /// 0: intact and solid. Above, the hull is a shell with holes, hatches lose their covers and masts lean or are lost;
  /// from 0.5 on the hull is broken in two.
  double damage = 0;
};

Assembly build_ship(const Ship& ship, RandomKey key);

}  // namespace ensonify
