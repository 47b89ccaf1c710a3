#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ensonify/sim/observe.hpp"

namespace ensonify {

/// What one frame of a block observed of its place's grid.
struct ObservedCells {
  int place = 0;
  std::vector<CellRun> runs;  ///< ascending, apart
};

/// Bytes that a block keeps until the grids are written, so that no ping is cast twice: numbers in LEB128, runs as the
/// gap since the last one and a count. About 3 bytes a run.
std::vector<std::uint8_t> pack(const std::vector<ObservedCells>& frames);

/// Throws DataError naming `name` where the bytes are not of pack.
std::vector<ObservedCells> unpack(std::span<const std::uint8_t> bytes, const std::filesystem::path& name);

}  // namespace ensonify
