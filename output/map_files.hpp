#pragma once

#include <filesystem>
#include <optional>

#include "ensonify/core/log_odds_map.hpp"

namespace ensonify {

/// Writes a map in the format that the extension names, whole or not at all:
///   .npz  log_odds f4, occupancy u1, observable u1 = known, origin, resolution (grid_npz.hpp)
///   .bt   OctoMap: occupied, free, and unknown left out          .ot   the same with log-odds
///   .pgm  nav2 slice at slice_z_m (world; none: the middle), unknown 205, with .yaml beside it
///   .ply  centres of occupied cells with log_odds
/// Throws ConfigError (unknown extension, a frame that the format can not hold) or DataError (disk).
void write_map(const LogOddsMap& map, const std::filesystem::path& path, std::optional<double> slice_z_m = {});

/// Reads a map back from .npz. Throws ConfigError (another extension) or DataError (a broken file).
LogOddsMap read_map(const std::filesystem::path& path);

/// Before the work: throws ConfigError where write_map would refuse this extension.
void require_map_format(const std::filesystem::path& path);

/// Bytes that write_map takes at worst, beside the map itself.
std::size_t bytes_to_write_map(const GridFrame& frame, const std::filesystem::path& path);

}  // namespace ensonify
