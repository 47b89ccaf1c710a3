#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ensonify/generators/dataset_plan.hpp"

namespace ensonify {

/// README.md: Hugging Face header, what is in the set, how to make it again.
void write_dataset_card(const DatasetPaths& paths, const nlohmann::json& manifest, const Recipe& recipe);
/// croissant.json: Croissant 1.0 JSON-LD over the files.
void write_croissant(const DatasetPaths& paths, const nlohmann::json& manifest);

}  // namespace ensonify
