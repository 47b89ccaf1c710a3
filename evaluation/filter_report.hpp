#pragma once

#include <string>
#include <vector>

#include "ensonify/evaluation/filter_scores.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

struct FilterReport {
  std::string dataset, root_hash;
  int val_frames = 0, test_frames = 0;
  std::vector<FilterScores> rows;
};

/// A line a filter, preset and scene; the same bits for the same dataset. Times stand apart: they never are.
std::string scores_csv(const FilterReport& report);
std::string times_csv(const FilterReport& report);
std::string scores_json(const FilterReport& report);

/// PSNR, SSIM, IoU and edges over all scenes with their intervals; precision over recall for every threshold.
PlotSheet scores_plots(const FilterReport& report);

/// The rows over all scenes for a terminal.
std::string scores_table(const FilterReport& report);

}  // namespace ensonify
