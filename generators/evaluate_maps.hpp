#pragma once

#include <string>
#include <vector>

#include "ensonify/evaluation/map_report.hpp"
#include "ensonify/generators/evaluate_filters.hpp"
#include "ensonify/generators/map_pings.hpp"

namespace ensonify {

struct MapEvaluation {
  std::string split = "test";
  std::vector<MapFilter> filters;
  std::vector<std::string> models;  ///< empty: all; oracle where the dataset has true elevations
  std::vector<MapPoses> poses = {MapPoses::truth};
  int threshold_max = 60;  ///< thresholds 0, 1 .. so far
  std::vector<int> tolerances = {0, 1};
  std::vector<double> fprs = {0.01, 0.05, 0.1};
  std::vector<std::string> places;  ///< of them; empty: all
  int max_frames = 0;               ///< of a place, evenly spread; 0: all
  double memory_bytes = 0;          ///< not to be exceeded
};

struct MapEvaluationResult {
  MapReport report;
  /// Of every place its truth and its maps from above, free cells beside occupied ones: a row a filter, with the first
  /// of the poses, at the threshold with the best F1.
  std::vector<std::pair<std::string, ContactSheet>> pictures;
};

/// Maps of every place of a split against its truth grid. The same bits for any number of threads. Throws ConfigError
/// or DataError, also where a place has no truth grid or observable cells.
MapEvaluationResult evaluate_maps(const Dataset& dataset, const MapEvaluation& what, const OnProgress& on_progress);

}  // namespace ensonify
