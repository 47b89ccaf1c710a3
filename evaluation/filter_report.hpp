#pragma once

#include <optional>
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

/// Whether curves show it: all filters would hide each other. Those of Lin et al., and the raw image.
bool is_of_the_paper(const FilterScores& row);

/// The masks of the filters of Lin et al. and of the raw image for every threshold; of one preset alone where it is
/// given.
Plot precision_over_recall(const FilterReport& report, const std::optional<std::string>& preset = {});

/// The rows over all scenes for a terminal.
std::string scores_table(const FilterReport& report);

}  // namespace ensonify
