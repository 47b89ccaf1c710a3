#pragma once

#include <filesystem>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// OctoMap binary tree (.bt; Hornung et al. 2013): surface and interior occupied, free cells explicit, pruned. With
/// `unobserved_is_unknown` cells that no ping observed are left out. OctoMap's cells begin at multiples of the
/// resolution and there are 65536 on an axis, centred on 0: throws ConfigError for a grid that does not fit this.
void write_grid_octomap(const OccupancyGrid& grid, const std::filesystem::path& path, bool unobserved_is_unknown);

/// OctoMap full tree (.ot) of a map: known cells with their log-odds (natural, positive = occupied, not clamped), free
/// ones explicit, unknown ones left out; inner nodes hold the greatest below. Throws as write_grid_octomap does.
void write_map_octomap(const LogOddsMap& map, const std::filesystem::path& path);

}  // namespace ensonify
