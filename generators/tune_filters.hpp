#pragma once

#include <string>
#include <vector>

#include "ensonify/filters/filter_grid.hpp"
#include "ensonify/generators/evaluate_filters.hpp"

namespace ensonify {

struct TunedStep {
  FilterStep step;
  int t = 0;       ///< best threshold
  double iou = 0;  ///< of its mask there, mean over the datasets
};

/// Every setting of every grid on the val splits, best first within its method: by the IoU of the best mask by a
/// threshold, averaged over the datasets. Masks decide, because maps are made of them.
std::vector<std::vector<TunedStep>> tune_filters(const std::vector<Dataset>& datasets,
                                                 const std::vector<FilterGrid>& grids, const EvaluateOptions& options,
                                                 const OnProgress& on_progress);

/// filter,settings,threshold,iou: a line a setting.
std::string tuning_csv(const std::vector<std::vector<TunedStep>>& tuned);

}  // namespace ensonify
