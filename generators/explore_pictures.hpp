#pragma once

#include "ensonify/core/colour.hpp"
#include "ensonify/generators/explore.hpp"

namespace ensonify {

/// What a step looks like, side by side: the ping's fan, the same filtered, the believed slice with the believed way,
/// the true slice with the true one. North is up. Slices: white free, black occupied, grey unknown; in the truth what
/// counts as reachable is tinted green, boundaries are red. Blue the way, orange the vehicle and where it looks.
Image2<Rgb> explore_strip(const ExplorePing& ping, const SonarGeometry& geometry, const Slice& map,
                          const std::vector<ExploreStep>& so_far, const ExploreSite& site, double radius_m);

}  // namespace ensonify
