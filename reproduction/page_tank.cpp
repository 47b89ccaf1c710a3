#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/estimate_series.hpp"
#include "ensonify/evaluation/filter_figures.hpp"
#include "ensonify/reproduction/map_curves.hpp"
#include "ensonify/reproduction/page.hpp"

namespace ensonify {
namespace {

const FilterScores* row_of_model(const FilterReport& report, const std::string& preset) {
  const auto row =
      std::ranges::find_if(report.rows, [&](const auto& r) { return r.preset == preset && r.scene == "all"; });
  return row == report.rows.end() ? nullptr : &*row;
}

std::vector<std::string> map_cells(const std::optional<MapFindings>& maps, const std::string& filter) {
  std::vector<std::string> cells;
  for (const char* model : {"points", "carve"}) {
    const MapCurve* curve = maps ? curve_of(maps->report, "all", filter, model, "true") : nullptr;
    const MapCounts n = curve ? curve->at[best_balanced(*curve)] : MapCounts{};
    for (const double value : {n.fpr(), n.fnr(), n.balanced_accuracy()}) cells.push_back(fixed(value, 3));
  }
  return cells;
}

ReportTable scores(const Findings& found) {
  ReportTable table{"Masks (threshold chosen on val) and maps (each at its own best t)",
                    {"filter", "IoU", "95 % from", "to", "F1", "FPR points", "FNR points", "balanced points",
                     "FPR carve", "FNR carve", "balanced carve"},
                    {},
                    1,
                    true};
  for (const FilterScores& row : found.tank_masks->rows) {
    if (row.scene != "all") continue;
    std::vector<std::string> cells{row.filter, fixed(row.iou.value, 3), fixed(row.iou.low, 3), fixed(row.iou.high, 3),
                                   fixed(row.f1.value, 3)};
    for (std::string& cell : map_cells(found.tank_maps, row.filter)) cells.push_back(std::move(cell));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// Of the networks that were trained on the tank alone.
ReportFigure over_pairs(const Findings& found) {
  Plot plot = titled_plot("", "", "IoU of the mask");
  Series bars{"", {}, {}, Series::Style::bars_with_errors};
  ReportTable table{"IoU over training pairs", {"network", "pairs", "IoU", "95 % from", "to"}, {}};
  for (const FewPairsModel& model : found.few_pairs) {
    const FilterScores* row = row_of_model(*found.tank_masks, model.name);
    if (!row) continue;
    add_estimate(bars, static_cast<double>(plot.categories.size()), row->iou);
    plot.categories.push_back(model.name);
    table.rows.push_back({model.label, std::to_string(model.pairs), fixed(row->iou.value, 3), fixed(row->iou.low, 3),
                          fixed(row->iou.high, 3)});
  }
  plot.series = {std::move(bars)};
  plot.y_range = {{0.0, 1.0}};
  return {
      "Sample efficiency",
      fmt::format("IoU of the mask in the tank; of the pooled pixels, lines: 95 % interval by bootstrap over frames. "
                  "tank_N was trained on N pairs, all for the same number of steps; paper_small has seen no tank; "
                  "transfer is paper_small fine-tuned on the pairs of tank_100. {}",
                  found.tank_source.line),
      "Bars of the IoU of masks by networks trained on 25 to 3000 pairs",
      figure_of(std::move(plot)),
      {std::move(table)}};
}

}  // namespace

ReportSection tank_section(const Findings& found) {
  ReportSection section{"The tank, and learning from few pairs", {}, {}, {}};
  if (!found.tank_masks) {
    section.paragraphs = {"Not shown: see what is missing."};
    return section;
  }
  section.paragraphs = {
      "The paper trained a second network on 100 labelled pairs of its own tank. Here the tank is simulated under the "
      "acoustics of a real Oculus (speckle, receiver noise, artefacts, multipath; recipe tank): the networks saw other "
      "layouts of it than the one they are judged in."};
  section.tables.push_back(scores(found));
  section.figures.push_back(over_pairs(found));
  if (!found.tank_maps) return section;
  for (const auto& [place, sheet] : found.tank_maps->pictures) {
    section.figures.push_back({"Maps of the tank",
                               fmt::format("From above, north up: left the free cells, right the occupied ones; bright "
                                           "observable cells, dim all others; each at its t with the best F1. {}",
                                           found.tank_source.line),
                               "Truth and maps of the tank from above by filter",
                               sheet,
                               {[&] {
                                 ReportTable table = scores(found);
                                 table.open = false;
                                 return table;
                               }()},
                               true});
  }
  return section;
}

}  // namespace ensonify
