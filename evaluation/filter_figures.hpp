#pragma once

#include <string>
#include <vector>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/output/report_page.hpp"

/// Figures and tables of a report of filters' scores.
namespace ensonify {

struct ShownScore {
  const char *title, *unit;
  Estimate FilterScores::*estimate;
  int digits;
};

/// "" stands for what has no preset: references and chains.
std::vector<std::string> presets_of(const FilterReport& report);

/// Without "all", in the order of the report.
std::vector<std::string> scenes_of(const FilterReport& report);

/// Of one scene ("all": every one), a line a filter and preset.
ReportTable score_table(const FilterReport& report, const std::string& scene);

/// A score over all scenes with its intervals: filters below each other, a mark a preset.
ReportFigure score_figure(const FilterReport& report, const ShownScore& score, std::string caption);

/// Precision over recall of the masks, of one preset and the raw image.
ReportFigure precision_figure(const FilterReport& report, const std::string& preset, const std::string& tail);

}  // namespace ensonify
