#pragma once

#include <string>
#include <vector>

#include "ensonify/evaluation/map_scores.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// The maps of one place by one filter and one model, for all thresholds.
struct MapCurve {
  std::string scene;                 ///< the place; "all": the cells of every place
  std::string filter, model, poses;  ///< poses: true or drifted
  int frames = 0;
  std::vector<MapCounts> at;  ///< a threshold each

  /// Index of the threshold with the greatest F1 of occupied with tolerance number `tolerance`; the lowest of equals.
  std::size_t best(std::size_t tolerance) const;
};

struct MapReport {
  std::string dataset, root_hash, split;
  std::vector<int> thresholds;  ///< grey levels
  std::vector<int> tolerances;  ///< cells
  std::vector<double> fprs;     ///< at which FNR is compared
  std::vector<MapCurve> curves;
};

/// Adds the curves over all places: counts summed over the places of the same filter, model and poses.
void add_pooled_curves(MapReport& report);

/// A line a scene, filter, model, poses and threshold. The same bits for the same dataset. Empty for 0 / 0.
std::string map_scores_csv(const MapReport& report);

/// A line a scene, filter, model and poses: the scores at its best threshold (the last tolerance's), FNR at equal FPR,
/// and for drifted poses what is lost against true ones at the threshold that is best with those.
std::string map_summary_csv(const MapReport& report);

/// Both, null for 0 / 0.
std::string map_scores_json(const MapReport& report);

/// The curves of one model over the threshold, one a filter. F1 is that of the last tolerance.
struct ModelPlots {
  std::string model;
  Plot fpr, fnr, balanced_accuracy, coverage, f1;
};

/// Only for a scene and poses; a model each.
std::vector<ModelPlots> model_plots(const MapReport& report, const std::string& scene, const std::string& poses);

/// FPR, FNR, coverage and F1 over thresholds, a row a model and a curve a filter. Only for a scene and poses.
PlotSheet map_plots(const MapReport& report, const std::string& scene, const std::string& poses);

/// map_summary_csv of the scene "all" for a terminal.
std::string map_table(const MapReport& report);

}  // namespace ensonify
