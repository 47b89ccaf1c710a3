#pragma once

#include "ensonify/generators/generate.hpp"

namespace ensonify {

/// Writes what belongs to the set as a whole: grids with what the set's pings observed, trajectories, metadata,
/// README.md, croissant.json, checksums.txt, and last dataset.json, whose presence says that all is there. False where
/// stopped.
bool finish_dataset(const FrameMaker& maker, const DatasetPaths& paths, const std::vector<Block>& blocks,
                    const GenerateOptions& options);

}  // namespace ensonify
