#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ensonify/generators/evaluate_maps.hpp"

namespace ensonify {

/// One way to make maps, over all thresholds 0..60 of Lin et al.
struct MapTask {
  MapFilter filter;
  std::vector<std::string> models;  ///< the first is the one that is shown
  std::vector<MapPoses> poses = {MapPoses::truth};
  std::string identity;  ///< of what the filter's name does not say, such as a model's hash
};

struct MapFindings {
  MapReport report;
  /// Of every place truth and maps from above (free beside occupied cells), by the first model of each task, at the
  /// threshold with the best F1.
  std::vector<std::pair<std::string, ContactSheet>> pictures;
};

/// Places of the split test that maps can be scored in: those with a truth grid and observable cells.
std::vector<std::string> places_with_truth(const Dataset& dataset);

/// Maps of these places for every task; a task that was done before, with the same dataset, is read from `kept`.
MapFindings study_maps(const Dataset& dataset, const std::vector<std::string>& places,
                       const std::vector<MapTask>& tasks, const std::filesystem::path& kept,
                       const OnProgress& on_progress);

}  // namespace ensonify
