#pragma once

#include "ensonify/sim/voxelize.hpp"

namespace ensonify::cli {

/// Says on standard error where the truth of a scene holds nothing of what the scene describes: objects outside of its
/// bounds, no obstacle at all, a navigable box without room.
void warn_of_void(const Scene& scene, const VoxelTruth& truth);

}  // namespace ensonify::cli
