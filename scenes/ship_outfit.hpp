#pragma once

#include <vector>

#include "ensonify/scenes/ship_form.hpp"

namespace ensonify {

/// Where a cargo hatch lies on the deck.
struct Hatch {
  double from_x_m, to_x_m;
  double half_width_m;
  bool covered;
};

std::vector<Hatch> ship_hatches(const Ship& ship, RandomKey key);

/// Everything on and below the hull: forecastle and poop, hatch coamings, deckhouse and funnel, masts with booms,
/// rudder, propeller and bulb. Each part carries the x of its foot in the translation of its transform.
Assembly ship_outfit(const Ship& ship, const std::vector<Hatch>& hatches, RandomKey key);

}  // namespace ensonify
