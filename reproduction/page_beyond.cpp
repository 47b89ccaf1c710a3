#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/filter_figures.hpp"
#include "ensonify/generators/acceptance_bands.hpp"
#include "ensonify/output/curve_table.hpp"
#include "ensonify/reproduction/map_curves.hpp"
#include "ensonify/reproduction/page.hpp"

namespace ensonify {
namespace {

ReportSection multipath_part(const Findings& found) {
  ReportSection part{"Multipath",
                     {"The recipe realistic has the acoustics of a real Oculus; multipath is background to the network "
                      "that was trained on it."},
                     {},
                     {}};
  if (!found.ghosts) return {"Multipath", {"Not shown: see what is missing."}, {}, {}};
  ReportTable table{
      "Share of multipath energy removed while 90 % of the direct pixels stay [%]", {"filter", "preset"}, {}, 2, true};
  const auto scenes = scenes_of(*found.ghosts);
  table.columns.insert(table.columns.end(), scenes.begin(), scenes.end());
  table.columns.emplace_back("all");
  for (const FilterScores& row : found.ghosts->rows) {
    if (row.scene != "all" || row.filter == "truth_mask") continue;
    std::vector<std::string> cells{row.filter, row.preset};
    for (const FilterScores& of : found.ghosts->rows) {
      if (of.filter == row.filter && of.preset == row.preset && of.scene != "all") {
        cells.push_back(percent(of.ghosts_removed.value));
      }
    }
    cells.push_back(percent(row.ghosts_removed.value));
    table.rows.push_back(std::move(cells));
  }
  part.tables.push_back(std::move(table));
  part.figures.push_back(score_figure(
      *found.ghosts, {"Ghosts removed", "share of multipath energy", &FilterScores::ghosts_removed, 3},
      "Energy of multipath below the threshold that keeps 90 % of the direct echoes of these frames; all scenes, "
      "lines: 95 % interval by bootstrap over frames. " +
          found.realistic_source.line));
  part.figures.push_back(
      score_figure(*found.ghosts, {"Masks under real acoustics", "IoU", &FilterScores::iou, 3},
                   "IoU of the mask at the threshold chosen on val; all scenes, lines: 95 % interval "
                   "by bootstrap over frames. " +
                       found.realistic_source.line));
  return part;
}

ReportSection arc_part(const Findings& found) {
  ReportSection part{"Inverse models that know of the arc",
                     {"arc marks all cells of a pixel's elevation arc; arc_shadow leaves what lies behind the first "
                      "return; carve keeps as occupied only what was never seen free. All at their own best t by "
                      "balanced accuracy, true poses."},
                     {},
                     {}};
  if (!found.maps) return {part.title, {"Not shown: see what is missing."}, {}, {}};
  const MapReport& report = found.maps->report;
  Plot plot = titled_plot("", "", "balanced accuracy");
  ReportTable table{"Balanced accuracy, all places", {"filter"}, {}, 1};
  const std::vector<std::string> models{"points", "arc", "arc_shadow", "carve"};
  plot.categories = models;
  table.columns.insert(table.columns.end(), models.begin(), models.end());
  for (const Contender& contender : found.contenders) {
    if (!curve_of(report, "all", contender.label, "carve", "true")) continue;
    Series series{contender.label, {}, {}, Series::Style::marked_line};
    std::vector<std::string> cells{contender.label};
    for (std::size_t m = 0; m < models.size(); ++m) {
      const MapCurve* curve = curve_of(report, "all", contender.label, models[m], "true");
      series.x.push_back(static_cast<double>(m));
      series.y.push_back(curve ? best_balanced_accuracy(*curve) : std::nan(""));
      cells.push_back(fixed(series.y.back(), 3));
    }
    plot.series.push_back(std::move(series));
    table.rows.push_back(std::move(cells));
  }
  part.figures.push_back(
      {"Arc models",
       "1 - (FPR + FNR) / 2 by inverse model, t from 0 to 60; cells of all places pooled. " + found.paper_source.line,
       "Balanced accuracy of four inverse models by filter",
       figure_of(std::move(plot)),
       {std::move(table)}});
  return part;
}

ReportSection loop_part(const Findings& found) {
  ReportSection part{"Closed loop",
                     {"The map chooses where the vehicle looks next (ensonify explore test_tank, model arc_shadow, "
                      "threshold 60, true poses): what a filter is worth shows in where the vehicle dares to go."},
                     {},
                     {}};
  Plot coverage = titled_plot("", "ping", "share of the free columns known");
  ReportTable ends{
      "After the last ping", {"filter", "pings", "end", "coverage", "walls found", "FPR", "FNR", "way [m]"}, {}, 1};
  for (const LoopRun& run : found.loops) {
    Series series{run.filter, {}, {}, Series::Style::marked_line};
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      series.x.push_back(static_cast<double>(i));
      series.y.push_back(run.steps[i].coverage);
    }
    coverage.series.push_back(std::move(series));
    if (run.steps.empty()) continue;
    const LoopStep& last = run.steps.back();
    ends.rows.push_back({run.filter, std::to_string(run.steps.size()), run.end, fixed(last.coverage, 3),
                         fixed(last.boundary_found, 3), fixed(last.fpr, 3), fixed(last.fnr, 3), fixed(last.path_m, 1)});
  }
  coverage.y_range = {{0.0, 1.0}};
  part.figures.push_back(
      {"Coverage",
       "Share of the columns that the vehicle can reach which its map knows to be free, ping by ping. "
       "Scene test_tank, noise of the paper, seed 0.",
       "Coverage over pings, a curve a filter",
       figure_of(std::move(coverage)),
       {std::move(ends)}});
  return part;
}

ReportSection real_part(const Findings& found) {
  if (!found.real) return {"Real pings beside simulated ones", {"Not shown: see what is missing."}, {}, {}};
  ReportTable table{"Figures of even tiles and of neighbouring pings", {"", "real", "simulated"}, {}, 1, true};
  const auto cell = [](const SideFigures& side, const std::string& id) {
    return fixed(band_value(side, id).value_or(std::nan("")), 4);
  };
  for (const AcceptanceBand& band : unbounded_bands()) {
    table.rows.push_back({band.quantity.empty() ? band.id : band.quantity, cell(found.real->real, band.id),
                          cell(found.real->simulated, band.id)});
  }
  return {
      "Real pings beside simulated ones",
      {"The learned filter never saw a real ping. The simulated one is of the same instrument over another bed: the "
       "two are alike in kind, not in what lies there."},
      {},
      {{"A real and a simulated ping",
        "Raw polar images as recorded, range downwards, and what the model realistic makes of them: mask, clean image.",
        "A real ping and a simulated one, each raw, as mask and cleaned",
        found.real->pictures,
        {std::move(table)},
        true}}};
}

ReportSection speed_part(const Findings& found) {
  ReportTable table{"A ping of 512 x 512 in pier_harbor with raw, clean, mask and labels",
                    {"noise", "ms", "pings a second"},
                    {},
                    1,
                    true};
  for (const PingTime& time : found.times.pings) {
    table.rows.push_back({time.noise, fixed(1e3 * time.s, 1), fixed(1 / time.s, 1)});
  }
  if (table.rows.empty()) return {"Speed of the simulator", {"Not shown: see what is missing."}, {}, {}};
  return {"Speed of the simulator",
          {"Each ping alone, on all cores of this machine. none is the echo alone, oculus_tank has coherent speckle, "
           "traced multipath and all artefacts."},
          {std::move(table)},
          {}};
}

}  // namespace

ReportSection beyond_section(const Findings& found) {
  ReportSection section{"Beyond the paper", {}, {}, {}, {}};
  section.parts = {multipath_part(found), arc_part(found), loop_part(found), real_part(found), speed_part(found)};
  return section;
}

}  // namespace ensonify
