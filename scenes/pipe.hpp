#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/assembly.hpp"

namespace ensonify {

/// A pipeline along its centre line.
struct Pipe {
  std::vector<Vec3> path_m;  ///< bends already rounded
  double radius_m = 0.2;     ///< outer
  double wall_m = 0;         ///< 0: solid, else open-ended and hollow
  int segments = 32;
  double flange_spacing_m = 0;  ///< 0: no flanges
  double flange_radius_m = 0.3;
  double flange_thickness_m = 0.06;
  int bolts = 0;  ///< on each flange
};

/// The path with every inner corner replaced by an arc of `bend_radius_m`. The first corner that has no room for its
/// arc is returned through `too_tight` (index into path_m), which is 0 otherwise.
std::vector<Vec3> round_corners(const std::vector<Vec3>& path_m, double bend_radius_m, std::size_t& too_tight);

/// The pipe is one mesh; flanges and bolts are instances of one mesh each. A flange sits at both ends too.
Assembly build_pipe(const Pipe& pipe);

}  // namespace ensonify
