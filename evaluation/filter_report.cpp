#include "ensonify/evaluation/filter_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ensonify/evaluation/csv_field.hpp"
#include "ensonify/evaluation/estimate_series.hpp"

namespace ensonify {
namespace {

using json = nlohmann::ordered_json;

struct Column {
  const char* name;
  Estimate FilterScores::*estimate;
};

constexpr std::array columns{Column{"psnr_db", &FilterScores::psnr_db},
                             Column{"ssim", &FilterScores::ssim},
                             Column{"edge_preservation", &FilterScores::edge_preservation},
                             Column{"looks", &FilterScores::looks},
                             Column{"gated_psnr_db", &FilterScores::gated_psnr_db},
                             Column{"masked_psnr_db", &FilterScores::masked_psnr_db},
                             Column{"masked_ssim", &FilterScores::masked_ssim},
                             Column{"precision", &FilterScores::precision},
                             Column{"recall", &FilterScores::recall},
                             Column{"iou", &FilterScores::iou},
                             Column{"f1", &FilterScores::f1},
                             Column{"ghosts_removed", &FilterScores::ghosts_removed}};

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }
json value_of(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

std::string label(const FilterScores& row) { return row.preset.empty() ? row.filter : row.filter + " " + row.preset; }

Plot bars(const FilterReport& report, const char* title, const char* unit, Estimate FilterScores::*estimate) {
  Plot plot = titled_plot(title, "", unit);
  Series series{"", {}, {}, Series::Style::bars_with_errors};
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all") continue;
    add_estimate(series, static_cast<double>(plot.categories.size()), row.*estimate);
    plot.categories.push_back(label(row));
  }
  double most = 0;
  for (const auto& ends : {series.y, series.y_high}) {
    for (const double end : ends) most = std::isfinite(end) ? std::max(most, end) : most;
  }
  plot.y_range = {{0.0, most > 0 ? 1.05 * most : 1.0}};
  plot.series = {std::move(series)};
  return plot;
}

constexpr std::array of_the_paper{"raw", "lee_enhanced", "frost", "anisodiff", "wavelet"};

}  // namespace

std::string scores_csv(const FilterReport& report) {
  std::string text = "filter,preset,scene,frames,threshold";
  for (const Column& c : columns) text += fmt::format(",{0},{0}_low,{0}_high", c.name);
  text += "\n";
  for (const FilterScores& row : report.rows) {
    text += fmt::format("{},{},{},{},{}", csv_field(row.filter), csv_field(row.preset), csv_field(row.scene),
                        row.psnr_db.frames, row.t);
    for (const Column& c : columns) {
      const Estimate& e = row.*c.estimate;
      text += fmt::format(",{},{},{}", number(e.value), number(e.low), number(e.high));
    }
    text += "\n";
  }
  return text;
}

std::string times_csv(const FilterReport& report) {
  std::string text = "filter,preset,scene,median_ms\n";
  for (const FilterScores& row : report.rows) {
    text += fmt::format("{},{},{},{:.3f}\n", csv_field(row.filter), csv_field(row.preset), csv_field(row.scene),
                        row.time_ms);
  }
  return text;
}

std::string scores_json(const FilterReport& report) {
  json root{{"dataset", report.dataset},
            {"root_hash", report.root_hash},
            {"val_frames", report.val_frames},
            {"test_frames", report.test_frames},
            {"confidence", 0.95},
            {"rows", json::array()}};
  for (const FilterScores& row : report.rows) {
    json entry{{"filter", row.filter}, {"preset", row.preset}, {"scene", row.scene}, {"threshold", row.t}};
    for (const Column& c : columns) {
      const Estimate& e = row.*c.estimate;
      entry[c.name] = {
          {"value", value_of(e.value)}, {"low", value_of(e.low)}, {"high", value_of(e.high)}, {"frames", e.frames}};
    }
    root["rows"].push_back(std::move(entry));
  }
  return root.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

bool is_of_the_paper(const FilterScores& row) {
  return std::ranges::find(of_the_paper, row.filter) != of_the_paper.end();
}

Plot precision_over_recall(const FilterReport& report, const std::optional<std::string>& preset) {
  Plot plot = titled_plot("Mask for every threshold, all scenes", "recall", "precision");
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all" || !is_of_the_paper(row)) continue;
    if (preset && !row.preset.empty() && row.preset != *preset) continue;
    Series series{label(row), {}, {}};
    for (int t = 1; t < 256; ++t) {
      const MaskCounts counts = row.levels.at(t);
      if (counts.true_positive == 0) break;
      series.x.push_back(counts.recall());
      series.y.push_back(counts.precision());
    }
    plot.series.push_back(std::move(series));
  }
  plot.x_range = plot.y_range = {{0.0, 1.0}};
  return plot;
}

PlotSheet scores_plots(const FilterReport& report) {
  PlotSheet sheet;
  sheet.plots = {bars(report, "Likeness to the clean twin", "PSNR [dB]", &FilterScores::psnr_db),
                 bars(report, "Likeness to the clean twin", "SSIM", &FilterScores::ssim),
                 bars(report, "Raw image under the filter's mask", "PSNR [dB]", &FilterScores::masked_psnr_db),
                 bars(report, "Mask at the threshold chosen on val", "IoU", &FilterScores::iou),
                 bars(report, "Edges kept", "correlation of Laplacians", &FilterScores::edge_preservation),
                 precision_over_recall(report)};
  sheet.columns = 2;
  sheet.width = 1800;
  sheet.height = 1800;
  return sheet;
}

std::string scores_table(const FilterReport& report) {
  std::string text = fmt::format("{:<14} {:<9} {:>8} {:>6} {:>6} {:>4} {:>6} {:>6} {:>6} {:>8} {:>8} {:>7} {:>8}\n",
                                 "filter", "preset", "PSNR dB", "SSIM", "edges", "t", "prec", "recall", "IoU",
                                 "gated dB", "raw dB", "ghosts", "ms");
  for (const FilterScores& row : report.rows) {
    if (row.scene != "all") continue;
    text +=
        fmt::format("{:<14} {:<9} {:8.2f} {:6.3f} {:6.3f} {:4} {:6.3f} {:6.3f} {:6.3f} {:8.2f} {:8.2f} {:>7} {:8.2f}\n",
                    row.filter, row.preset, row.psnr_db.value, row.ssim.value, row.edge_preservation.value, row.t,
                    row.precision.value, row.recall.value, row.iou.value, row.gated_psnr_db.value,
                    row.masked_psnr_db.value, number(std::round(1000 * row.ghosts_removed.value) / 1000), row.time_ms);
  }
  return text;
}

}  // namespace ensonify
