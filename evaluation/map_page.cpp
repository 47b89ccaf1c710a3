#include "ensonify/evaluation/map_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/map_summary.hpp"
#include "ensonify/output/curve_table.hpp"

namespace ensonify {
namespace {

/// A name of summary_of as a reader's: "f1_k1" -> "F1 k1".
std::string label_of(std::string name) {
  if (name == "best_threshold") return "t";
  std::ranges::replace(name, '_', ' ');
  for (const auto& [from, to] :
       {std::pair{"fpr", "FPR"}, {"fnr", "FNR"}, {"iou", "IoU"}, {"f1", "F1"}, {"brier", "Brier"}}) {
    const std::string_view word = from;
    for (std::size_t at = name.find(word); at != name.npos; at = name.find(word)) name.replace(at, word.size(), to);
  }
  return name;
}

/// The greatest, in words.
std::string tolerance_of(const MapReport& report) {
  const int k = report.tolerances.back();
  return k == 1 ? "1 cell" : fmt::format("{} cells", k);
}

/// A line a filter, model and poses; columns that hold no number are left out.
ReportTable summary_table(const MapReport& report, const std::string& scene) {
  ReportTable table{scene == "all" ? "Scores over all places" : fmt::format("Scores in {}", scene),
                    {"filter", "model", "poses"},
                    {},
                    3,
                    scene == "all"};
  std::vector<std::vector<std::pair<std::string, double>>> lines;
  for (const MapCurve& curve : report.curves) {
    if (curve.scene != scene) continue;
    lines.push_back(summary_of(report, curve));
    table.rows.push_back({curve.filter, curve.model, curve.poses});
  }
  for (std::size_t c = 0; !lines.empty() && c < lines[0].size(); ++c) {
    if (std::ranges::none_of(lines, [&](const auto& line) { return std::isfinite(line[c].second); })) continue;
    table.columns.push_back(label_of(lines[0][c].first));
    for (std::size_t r = 0; r < lines.size(); ++r) table.rows[r].push_back(fixed(lines[r][c].second, c == 0 ? 0 : 3));
  }
  return table;
}

int frames_of(const MapReport& report, const std::string& scene) {
  const auto found = std::ranges::find(report.curves, scene, &MapCurve::scene);
  return found == report.curves.end() ? 0 : found->frames;
}

ReportFigure curve_figure(Plot plot, const std::string& title, const std::string& caption) {
  ReportTable table = curve_table(plot, 0, 3);
  for (Series& series : plot.series) series.style = Series::Style::marked_line;
  std::string alt = fmt::format("Curves of {} over the threshold, a curve a filter", plot.y_label);
  return {title, caption, std::move(alt), figure_of(std::move(plot)), {std::move(table)}};
}

ReportSection over_threshold(const MapReport& report, const std::string& poses, const std::string& source) {
  ReportSection section{fmt::format("Over the threshold, {} poses", poses), {}, {}, {}};
  const std::string tail =
      fmt::format("{} frames of {}, cells of all places pooled. {}", frames_of(report, "all"), report.split, source);
  for (ModelPlots& of : model_plots(report, "all", poses)) {
    section.parts.push_back(
        {fmt::format("Model {}", of.model),
         {},
         {},
         {curve_figure(std::move(of.fpr), "FPR", "Share of the known occupied cells that the map calls free. " + tail),
          curve_figure(std::move(of.fnr), "FNR", "Share of the known free cells that the map calls occupied. " + tail),
          curve_figure(std::move(of.balanced_accuracy), "Balanced accuracy", "1 - (FPR + FNR) / 2. " + tail),
          curve_figure(std::move(of.coverage), "Coverage", "Share of the observable cells that the map knows. " + tail),
          curve_figure(std::move(of.f1), "F1 of occupied cells",
                       fmt::format("A surface within {} counts as right. ", tolerance_of(report)) + tail)}});
  }
  return section;
}

}  // namespace

ReportPage map_page(const MapReport& report, std::vector<std::pair<std::string, ContactSheet>> pictures,
                    const ReportSource& source) {
  ReportPage page{
      fmt::format("Maps of {}", report.dataset),
      fmt::format("Occupancy maps of {} places from {} frames of the split {}, against the cells that the pings "
                  "could observe. Free is positive: FPR counts occupied cells called free.",
                  pictures.size(), frames_of(report, "all"), report.split),
      source.facts,
      {}};
  page.sections.push_back(
      {"Scores",
       {fmt::format("At the threshold t with the best F1 of occupied cells, a surface within {} counting as right "
                    "(k: the tolerance in cells). FNR at FPR: the least FNR among thresholds with so low an FPR. Loss: "
                    "score with true poses less that with drifted ones, at the threshold that is best with true ones.",
                    tolerance_of(report))},
       {summary_table(report, "all")},
       {}});
  for (const char* poses : {"true", "drifted"}) {
    if (!std::ranges::any_of(report.curves, [&](const MapCurve& c) { return c.poses == poses; })) continue;
    page.sections.push_back(over_threshold(report, poses, source.line));
  }
  ReportSection places{"Places", {}, {}, {}};
  for (auto& [place, sheet] : pictures) {
    places.figures.push_back({fmt::format("Maps of {}", place),
                              fmt::format("From above, north up: left the free cells, right the occupied ones; bright "
                                          "observable cells, dim all others. {} frames of {}. {}",
                                          frames_of(report, place), report.split, source.line),
                              fmt::format("Truth and maps of {} from above, by filter and model", place),
                              std::move(sheet),
                              {summary_table(report, place)},
                              true});
  }
  page.sections.push_back(std::move(places));
  return page;
}

}  // namespace ensonify
