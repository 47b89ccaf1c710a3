#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/estimate_series.hpp"
#include "ensonify/evaluation/filter_figures.hpp"
#include "ensonify/reproduction/map_curves.hpp"
#include "ensonify/reproduction/page.hpp"

namespace ensonify {
namespace {

/// Bars of what every contender hands on, in one scene.
ReportFigure psnr_figure(const Findings& found, const std::string& scene) {
  const FilterReport& report = *found.filters;
  Plot plot = titled_plot("", "", "PSNR [dB]");
  Series bars{"", {}, {}, Series::Style::bars_with_errors};
  ReportTable table{"PSNR", {"filter", "PSNR [dB]", "95 % from", "to", "frames"}, {}};
  double most = 1;
  for (const Contender& contender : found.contenders) {
    const FilterScores* row = row_of(report, contender, scene);
    if (!row) continue;
    const Estimate& e = row->*contender.psnr_db;
    add_estimate(bars, static_cast<double>(plot.categories.size()), e);
    plot.categories.push_back(contender.label);
    table.rows.push_back(
        {contender.label, fixed(e.value, 2), fixed(e.low, 2), fixed(e.high, 2), std::to_string(e.frames)});
    most = std::max({most, e.value, std::isfinite(e.high) ? e.high : 0});
  }
  plot.y_range = {{0.0, 1.05 * most}};
  plot.series = {std::move(bars)};
  const std::string what = scene == "all" ? "All scenes" : scene;
  return {
      "PSNR, " + what,
      fmt::format("10 log10(255² / mean squared difference) against the clean twin, before the unsharp filter; mean "
                  "over frames, lines: 95 % interval (Student). {}",
                  found.paper_source.line),
      fmt::format("Bars of the PSNR of every filter, {}", what),
      figure_of(std::move(plot)),
      {std::move(table)}};
}

}  // namespace

ReportSection filter_section(const Findings& found) {
  ReportSection section{"Filters", {}, {}, {}};
  if (!found.filters) {
    section.paragraphs = {"Not shown: see what is missing."};
    return section;
  }
  section.paragraphs = {
      "lee_enhanced, frost, anisodiff and wavelet are the paper's, with its parameters. learned is its own: a "
      "network's "
      "mask applied to the raw image. learned_clean is what the same network says the image would be without noise. "
      "truth_mask applies the true mask: no mask can do better."};
  ReportTable shown = score_table(*found.filters, "all");
  shown.open = false;
  section.figures.push_back(
      {"A frame of every scene",
       fmt::format("The middle frame of each place of test; range downwards, port on the left. {}",
                   found.paper_source.line),
       "A frame of every scene: clean, mask, and through every filter",
       found.frames,
       {std::move(shown)},
       true});
  for (const std::string& scene : scenes_of(*found.filters)) section.figures.push_back(psnr_figure(found, scene));
  section.figures.push_back(psnr_figure(found, "all"));
  ReportTable all = score_table(*found.filters, "all");
  all.caption = "All filters that were judged, both presets, all scenes";
  section.tables.push_back(std::move(all));
  return section;
}

ReportSection time_section(const Findings& found) {
  ReportTable table{"Seconds a frame", {"filter", "the paper [s]", "here [s]", "times faster"}, {}, 1, true};
  for (const FilterTime& time : found.times.filters) {
    const auto contender = std::ranges::find(found.contenders, time.label, &Contender::label);
    const double theirs =
        contender == found.contenders.end() ? std::nan("") : contender->paper_s.value_or(std::nan(""));
    table.rows.push_back({time.label, fixed(theirs, 2), fixed(time.s, 4), fixed(theirs / time.s, 0)});
  }
  ReportSection section{"Time a frame",
                        {"Median of frames of 512 x 512 pixels, each alone; networks and nlm use all cores, the others "
                         "one. The paper's are those of Python on a CPU of its time. These numbers, and those of the "
                         "simulator's speed, are the only ones of this page that differ from run to run."},
                        {},
                        {}};
  if (table.rows.empty()) {
    section.paragraphs = {"Not shown: see what is missing."};
  } else {
    section.tables.push_back(std::move(table));
  }
  return section;
}

}  // namespace ensonify
