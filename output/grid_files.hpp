#pragma once

#include <filesystem>
#include <optional>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// What some of the formats leave open.
struct GridFileOptions {
  std::optional<double> slice_z_m = {};  ///< .pgm: height of the slice (world); none: the middle of the grid
  bool unobserved_is_unknown = false;    ///< .bt, .pgm: cells that no ping observed are unknown
};

/// Writes the grid in the format that the extension names: .npz, .bt, .pgm (and .yaml), .ply or .vdb, whole or not at
/// all. Throws ConfigError (unknown extension, a grid the format can not hold) or DataError (disk).
void write_grid(const OccupancyGrid& grid, const std::filesystem::path& path, const GridFileOptions& options = {});

/// Reads a grid back from .npz. Throws ConfigError (another extension) or DataError (a broken file).
OccupancyGrid read_grid(const std::filesystem::path& path);

}  // namespace ensonify
