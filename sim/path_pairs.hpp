#pragma once

#include "ensonify/sim/path_image.hpp"
#include "ensonify/sim/path_points.hpp"

namespace ensonify {

/// Joins points of the fan with each other (see `path_pair`) and adds every pair at both of its bearings. Whether a
/// tile sees a block of tiles is asked by one ray, of a pair picked in proportion to its energy: so the energy of the
/// pairs is free of noise, and their visibility right on average.
void add_joined_pairs(const PathView& view, const PathHits& hits, PathImage& image);

}  // namespace ensonify
