#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/generators/dataset_stats.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// A curve a split each.
struct StatsPlots {
  Plot mask_share, raw_levels, clean_levels, raw_over_range, mask_over_range;
  std::vector<std::pair<std::string, Plot>> poses, sampled;  ///< by key; of what was sampled, the first twelve
};

StatsPlots plots_of(const DatasetStats& stats);

/// One sheet, a curve a split: mask share, grey levels, range profile, poses and what was sampled.
PlotSheet stats_plots(const DatasetStats& stats);

}  // namespace ensonify
