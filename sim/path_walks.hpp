#pragma once

#include "ensonify/sim/path_image.hpp"
#include "ensonify/sim/path_points.hpp"

namespace ensonify {

/// Walks from every point of the fan into a direction that its surface prefers, to a second surface that the sonar sees
/// too: pairs that `add_joined_pairs` finds too rarely, in mirrors and in corners. With order 3 the walk goes on from
/// there to a third surface. Adds every path at the bearings of both of its ends.
void add_walked_paths(const RayScene& scene, const PathFan& fan, const PathHits& hits, const RayAxes& axes, int order,
                      float reach_m, PathImage& image);

}  // namespace ensonify
