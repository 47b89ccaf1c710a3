#pragma once

#include <optional>

#include "ensonify/core/pose.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

/// Range (m) of the first surface along a unit direction, world frame; empty where there is none within reach_m.
std::optional<double> first_hit_m(const RayScene& scene, const Vec3& origin_m, const Vec3& direction, double reach_m);

}  // namespace ensonify
