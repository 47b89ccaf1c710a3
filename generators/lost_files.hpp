#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_plan.hpp"

namespace ensonify {

/// A file of a finished set that is gone, or that has not the length with which its block was written; empty where all
/// are there. Reads no file but the lists: what changed within its length is for `verify_dataset`.
std::optional<std::string> lost_file(const DatasetPaths& paths, const std::vector<Block>& blocks);

}  // namespace ensonify
