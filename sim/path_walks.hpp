#pragma once

#include <vector>

#include "ensonify/sim/path_image.hpp"
#include "ensonify/sim/path_points.hpp"

namespace ensonify {

/// Walks from every point into directions that its surface prefers, to a second surface that the sonar sees too: pairs
/// that `add_joined_pairs` finds too rarely, in mirrors and in corners. With order 3 a walk goes on from there to a
/// third surface. Adds every path at the bearings of both of its ends.
void add_walked_paths(const PathView& view, const PathHits& hits, int order, PathImage& image);

/// Energy of the paths over two surfaces that begin or end in each cell, roughly, from walks alone.
std::vector<float> walked_energy(const PathView& view, const PathHits& hits);

}  // namespace ensonify
