#include "ensonify/evaluation/filter_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ensonify/evaluation/estimate_series.hpp"

namespace ensonify {
namespace {

constexpr std::array shown_scores{ShownScore{"", "PSNR [dB]", &FilterScores::psnr_db, 2},
                                  ShownScore{"", "SSIM", &FilterScores::ssim, 3},
                                  ShownScore{"", "edges", &FilterScores::edge_preservation, 3},
                                  ShownScore{"", "looks", &FilterScores::looks, 1},
                                  ShownScore{"", "precision", &FilterScores::precision, 3},
                                  ShownScore{"", "recall", &FilterScores::recall, 3},
                                  ShownScore{"", "IoU", &FilterScores::iou, 3},
                                  ShownScore{"", "F1", &FilterScores::f1, 3},
                                  ShownScore{"", "gated PSNR [dB]", &FilterScores::gated_psnr_db, 2},
                                  ShownScore{"", "masked PSNR [dB]", &FilterScores::masked_psnr_db, 2},
                                  ShownScore{"", "masked SSIM", &FilterScores::masked_ssim, 3},
                                  ShownScore{"", "ghosts removed", &FilterScores::ghosts_removed, 3}};

std::string name_of(const std::string& preset) { return preset.empty() ? "no preset" : preset; }

}  // namespace

std::vector<std::string> presets_of(const FilterReport& report) {
  std::vector<std::string> presets;
  for (const FilterScores& row : report.rows) {
    if (std::ranges::find(presets, row.preset) == presets.end()) presets.push_back(row.preset);
  }
  return presets;
}

std::vector<std::string> scenes_of(const FilterReport& report) {
  std::vector<std::string> scenes;
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all" && std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
  }
  return scenes;
}

ReportTable score_table(const FilterReport& report, const std::string& scene) {
  ReportTable table{scene == "all" ? "Scores over all scenes" : fmt::format("Scores in {}", scene),
                    {"filter", "preset", "t"},
                    {},
                    2,
                    scene == "all"};
  std::vector<ShownScore> scores(shown_scores.begin(), shown_scores.end());
  std::erase_if(scores, [&](const ShownScore& s) {  // ghosts, where the dataset has no multipath
    return std::ranges::none_of(report.rows, [&](const auto& row) { return std::isfinite((row.*s.estimate).value); });
  });
  for (const ShownScore& score : scores) table.columns.emplace_back(score.unit);
  for (const FilterScores& row : report.rows) {
    if (row.scene != scene) continue;
    std::vector<std::string> cells{row.filter, row.preset, std::to_string(row.t)};
    for (const ShownScore& score : scores) cells.push_back(fixed((row.*score.estimate).value, score.digits));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

ReportFigure score_figure(const FilterReport& report, const ShownScore& score, std::string caption) {
  const std::vector<std::string> presets = presets_of(report);
  Plot plot = titled_plot("", "", score.unit);
  plot.sideways = true;
  for (const std::string& preset : presets) {
    plot.series.push_back({name_of(preset), {}, {}, Series::Style::points_with_errors});
  }
  const auto place_of = [&](const std::string& preset) {  // among those with a name
    return std::count_if(presets.begin(), std::ranges::find(presets, preset), [](const auto& p) { return !p.empty(); });
  };
  const auto named = static_cast<double>(place_of("no such preset"));
  const double step = 0.5 / std::max(1.0, named);
  ReportTable table{score.title, {"filter", "preset", score.unit, "95 % from", "to"}, {}, 2};
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all") continue;
    auto& names = plot.categories;
    auto at = std::ranges::find(names, row.filter) - names.begin();
    if (at == static_cast<std::ptrdiff_t>(names.size())) names.push_back(row.filter);
    const auto preset = static_cast<std::size_t>(std::ranges::find(presets, row.preset) - presets.begin());
    const double aside =
        row.preset.empty() ? 0 : step * (static_cast<double>(place_of(row.preset)) - 0.5 * (named - 1));
    const Estimate& e = row.*score.estimate;
    Series& series = plot.series[preset];
    add_estimate(series, static_cast<double>(at) + aside, e);
    table.rows.push_back({row.filter, row.preset, fixed(e.value, score.digits), fixed(e.low, score.digits),
                          fixed(e.high, score.digits)});
  }
  const int height = 110 + 22 * static_cast<int>(plot.categories.size());
  const std::string alt = fmt::format("{} of every filter with its interval, a mark a preset", score.unit);
  return {score.title, std::move(caption), alt, figure_of(std::move(plot), 440, height), {std::move(table)}};
}

ReportFigure precision_figure(const FilterReport& report, const std::string& preset, const std::string& tail) {
  Plot plot = precision_over_recall(report, preset);
  ReportTable table{"Precision and recall over the threshold", {"t"}, {}, 1};
  std::vector<const FilterScores*> rows;
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all" || !is_of_the_paper(row) || (!row.preset.empty() && row.preset != preset)) continue;
    rows.push_back(&row);
    table.columns.push_back(row.filter + ": precision");
    table.columns.push_back("recall");
  }
  for (int t = 1; t < 256; ++t) {
    std::vector<std::string> cells{std::to_string(t)};
    for (const FilterScores* row : rows) {
      const MaskCounts counts = row->levels.at(t);
      cells.push_back(fixed(counts.precision(), 3));
      cells.push_back(fixed(counts.recall(), 3));
    }
    table.rows.push_back(std::move(cells));
  }
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    plot.series[s].style = Series::Style::marked_line;
    plot.series[s].name = rows[s]->filter;  // the title says which preset
  }
  return {
      fmt::format("Precision over recall, preset {}", preset),
      "Masks at every threshold from 1 to 255, pixels of all frames pooled; the filters of Lin et al. and the raw "
      "image. " +
          tail,
      fmt::format("Curves of precision over recall for the raw image and the filters of the paper, preset {}", preset),
      figure_of(std::move(plot), 440, 380),
      {std::move(table)}};
}

}  // namespace ensonify
