#pragma once

#include <vector>

#include "ensonify/scenes/tube.hpp"

namespace ensonify {

/// Tubular lattice beam along +x from the origin, its width about y = 0, the lower chords on z = 0.
struct Truss {
  double length_m = 12;
  double width_m = 1;
  double height_m = 1;
  int bays = 8;
  bool triangular = false;  ///< one upper chord instead of two
  double chord_radius_m = 0.06;
  double brace_radius_m = 0.03;
};

/// Four-legged steel jacket on z = 0, about the z axis, its legs leaning inwards.
struct Jacket {
  double height_m = 30;
  double base_width_m = 16;
  double top_width_m = 8;
  double leg_radius_m = 0.6;
  int levels = 3;  ///< panels of bracing, one above the other
  bool k_braces = false;
  double brace_radius_m = 0.3;
  double pile_radius_m = 0;  ///< piles beside the feet, two a leg; 0: none
  double pile_length_m = 4;  ///< above and under the ground alike
};

std::vector<Member> truss_members(const Truss& truss);
std::vector<Member> jacket_members(const Jacket& jacket);

}  // namespace ensonify
