#pragma once

#include "ensonify/generators/dataset_stats.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// One sheet, a curve a split: mask share, grey levels, range profile, poses and what was sampled.
PlotSheet stats_plots(const DatasetStats& stats);

}  // namespace ensonify
