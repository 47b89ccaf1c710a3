#pragma once

#include <optional>

#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/generators/place.hpp"
#include "ensonify/generators/recipe.hpp"

namespace ensonify {

struct SampledPose {
  Pose T_world_sonar = Pose::Identity();
  int tries = 0;
};

/// Draws poses until one keeps the rules of `RandomPoses`; empty after `poses.tries`.
std::optional<SampledPose> sample_pose(const RandomPoses& poses, const Place& place, const SonarGeometry& geometry,
                                       RandomKey key);

}  // namespace ensonify
