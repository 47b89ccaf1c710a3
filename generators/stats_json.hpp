#pragma once

#include <string>

#include "ensonify/generators/dataset_stats.hpp"

namespace ensonify {

/// The figures as JSON text (schema: docs/datasets.md). Says nothing of the run: no time, no path, no threads.
std::string stats_json(const DatasetStats& stats);

}  // namespace ensonify
