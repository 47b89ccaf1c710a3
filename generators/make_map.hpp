#pragma once

#include <filesystem>
#include <optional>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/generators/evaluate_filters.hpp"
#include "ensonify/generators/map_pings.hpp"
#include "ensonify/mapping/inverse_model.hpp"

namespace ensonify {

struct MapRequest {
  std::string split = "test";
  std::string place;  ///< empty: the only one
  MapFilter filter;
  double threshold = 30;  ///< grey level
  InverseModel model = Points{};
  MapPoses poses = MapPoses::truth;
  std::optional<double> resolution_m;  ///< none: that of the truth grid
  int max_frames = 0;                  ///< of the place, evenly spread; 0: all
  std::filesystem::path file;          ///< its format counts in memory
  double memory_bytes = 0;             ///< more is refused
};

struct MadeMap {
  LogOddsMap map;
  std::string place;
  int frames = 0;
  bool ordered = true;    ///< false: random poses
  bool as_truth = false;  ///< the box is that of the place's truth grid
};

/// The map of one place. Its box is that of the place's truth grid where the dataset has one (the same cells, if the
/// resolution is that grid's), else what the pings reach. The same bits for any number of threads. Throws ConfigError,
/// also where the map may not fit into memory, and DataError.
MadeMap make_map(const Dataset& dataset, const MapRequest& request, const OnProgress& on_progress);

}  // namespace ensonify
