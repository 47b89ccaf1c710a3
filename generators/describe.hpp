#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ensonify/generators/recipe.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Resolved settings as JSON, for manifests; keys as in the YAML files.
nlohmann::json describe(const Distribution& distribution);
/// Of a dataset's manifest.
inline constexpr const char* dataset_schema = "ensonify-dataset";

/// What load_recipe() reads, too.
nlohmann::json describe(const Recipe& recipe);
nlohmann::json describe(const SonarModel& sonar);
nlohmann::json describe(const NoiseProfile& noise);
/// The profile, or a list where there are several.
nlohmann::json describe(const std::vector<NoiseProfile>& noise);

/// Row-major 4 x 4.
nlohmann::json describe(const Pose& T_a_b);

}  // namespace ensonify
