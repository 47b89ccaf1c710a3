#pragma once

#include "ensonify/sim/voxelize.hpp"

namespace ensonify::cli {

/// Says on standard error where the truth of a scene holds nothing of what the scene describes: objects outside of its
/// bounds, no obstacle at all, a navigable box without room.
void warn_of_void(const Scene& scene, const VoxelTruth& truth);

/// The same of a ping whose sonar is above the water, or that met no surface between its ranges (m).
void warn_of_place(const Scene& scene, const Vec3& sonar_m, bool silent, double range_min_m, double range_max_m);

}  // namespace ensonify::cli
