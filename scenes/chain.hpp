#pragma once

#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/catenary.hpp"

namespace ensonify {

/// Stud-less link about its centre, its long side along x, flat in x, y. Lengths are outer ones.
struct ChainLink {
  double length_m = 0.3;
  double width_m = 0.18;  ///< at most the length
  double wire_radius_m = 0.025;

  /// From link to link in a taut chain.
  double pitch_m() const { return length_m - 4 * wire_radius_m; }
};

TriangleMesh make_chain_link(const ChainLink& link);

/// Links along a line, each turned 90 degrees against the one before: as many as fit best, stretched by the remainder
/// so that the bearing points of the first and the last lie on the ends.
Assembly build_chain(const ChainLink& link, const HangingLine& line);

/// Links that build_chain uses.
int chain_links(const ChainLink& link, const HangingLine& line);

}  // namespace ensonify
