#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/generators/explore.hpp"

namespace ensonify {

/// One line a step. Columns and keys alike: step, time_s, x_m .. yaw_deg (true), est_x_m .. est_yaw_deg, coverage,
/// boundary_found, fpr, fnr, clearance_m, path_m; 0 / 0 is nan in CSV, null in JSON.
std::string steps_csv(const ExploreRun& run);
std::string steps_jsonl(const ExploreRun& run);

/// Seconds of the computer's clock, a line a step: no two runs have the same.
std::string times_csv(const ExploreRun& run);

/// How it ended, the last scores, least clearance, way, and when which coverage was reached.
nlohmann::json summary_of(const ExploreRun& run, const ExploreSite& site, const Vehicle& vehicle);

/// The map's log_odds f4 [z, y, x] with origin and resolution, as numpy reads it. Same bytes for the same map.
void write_explored_map(const LogOddsGrid& grid, const std::filesystem::path& path);

/// A guest's map as a slice: a column of `like` takes the cells of the map whose centres lie over or under its centre,
/// within the layers of `slab`.
Slice columns_of(const LogOddsMap& map, const Slice& like, const GridFrame& slab);

/// The same of a map that a plug-in wrote: log_odds (floats, positive = occupied, 0 = unknown), or occupancy and
/// observable, with origin and resolution. Throws DataError.
Slice read_guest_map(const std::filesystem::path& path, const Slice& like, const GridFrame& slab);

}  // namespace ensonify
