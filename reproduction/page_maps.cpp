#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "ensonify/output/curve_table.hpp"
#include "ensonify/reproduction/map_curves.hpp"
#include "ensonify/reproduction/page.hpp"

namespace ensonify {
namespace {

ReportFigure curve_figure(Plot plot, const std::string& title, const std::string& caption) {
  ReportTable table = curve_table(plot, 0, 3);
  for (Series& series : plot.series) series.style = Series::Style::marked_line;
  const std::string alt = fmt::format("{} over the threshold, a curve a filter", title);
  return {title, caption, alt, figure_of(std::move(plot), 440, 340), {std::move(table)}};
}

/// The paper's model alone, without the true mask, which the learned filter's curve would hide.
MapReport of_the_paper(const MapReport& report) {
  MapReport chosen = report;
  std::erase_if(chosen.curves, [](const MapCurve& c) { return c.model != "points" || c.filter == "truth_mask"; });
  return chosen;
}

std::vector<ReportFigure> curves_over_t(const MapReport& report, const std::string& scene, const std::string& poses,
                                        const std::string& source) {
  std::vector<ModelPlots> plots = model_plots(of_the_paper(report), scene, poses);
  if (plots.empty()) return {};
  const std::string tail =
      fmt::format("{}, {} poses. {}", scene == "all" ? "Cells of all places pooled" : scene, poses, source);
  std::vector<ReportFigure> figures{
      curve_figure(std::move(plots[0].fpr), fmt::format("FPR, {}", scene),
                   "Share of the known occupied cells that the map calls free, t from 0 to 60. " + tail),
      curve_figure(std::move(plots[0].fnr), fmt::format("FNR, {}", scene),
                   "Share of the known free cells that the map calls occupied. " + tail)};
  if (scene == "all") {
    figures.push_back(
        curve_figure(std::move(plots[0].balanced_accuracy), "Balanced accuracy, all", "1 - (FPR + FNR) / 2. " + tail));
    figures.push_back(curve_figure(std::move(plots[0].coverage), "Coverage, all",
                                   "Share of the observable cells that the map knows. " + tail));
  }
  return figures;
}

/// At the threshold with the best balanced accuracy of each, all places.
ReportTable best_table(const MapReport& report) {
  ReportTable table{"All places, each filter and model at its own best t (balanced accuracy)",
                    {"filter", "model", "poses", "t", "coverage", "FPR", "FNR", "balanced", "mean FPR", "mean FNR"},
                    {},
                    3,
                    true};
  for (const MapCurve& c : report.curves) {
    if (c.scene != "all") continue;
    const std::size_t best = best_balanced(c);
    const MapCounts& n = c.at[best];
    double fpr = 0, fnr = 0;
    for (const MapCounts& at : c.at) {
      fpr += at.fpr() / static_cast<double>(c.at.size());
      fnr += at.fnr() / static_cast<double>(c.at.size());
    }
    table.rows.push_back({c.filter, c.model, c.poses, std::to_string(report.thresholds[best]), fixed(n.coverage(), 3),
                          fixed(n.fpr(), 3), fixed(n.fnr(), 3), fixed(n.balanced_accuracy(), 3), fixed(fpr, 3),
                          fixed(fnr, 3)});
  }
  return table;
}

/// Scores of one place as the table of a figure.
ReportTable place_table(const MapReport& report, const std::string& place) {
  MapReport of_place = report;
  std::erase_if(of_place.curves, [&](const MapCurve& c) { return c.scene != place || c.poses != "true"; });
  for (MapCurve& curve : of_place.curves) curve.scene = "all";
  ReportTable table = best_table(of_place);
  table.caption = "Scores in " + place;
  table.open = false;
  return table;
}

void append(std::vector<ReportFigure>& figures, std::vector<ReportFigure> more) {
  std::ranges::move(more, std::back_inserter(figures));
}

}  // namespace

ReportSection map_section(const Findings& found) {
  ReportSection section{"Occupancy maps", {}, {}, {}, {}};
  if (!found.maps || !found.maps_as_the_paper) {
    section.paragraphs = {"Not shown: see what is missing."};
    return section;
  }
  const std::string& source = found.paper_source.line;
  const MapReport& report = found.maps->report;
  section.paragraphs = {
      "The paper's inverse model is points: elevation is taken as 0, a level of t or more is occupied, all before is "
      "free. "
      "Free is positive, as in the paper: FPR counts occupied cells called free. Cells that no ping could observe are "
      "not "
      "scored.",
      "A rate alone can be bought with the other: a map that calls everything occupied has FPR 0. So tables have the "
      "balanced accuracy, and the means of both rates over all t, too."};
  ReportSection as_the_paper{
      "As in the paper",
      {"Filter, unsharp filter, histogram equalisation. Equalised, a threshold is a share of the pixels: t = 60 leaves "
       "the darkest quarter out, whatever it is. Images with noise everywhere keep most of it."},
      {best_table(found.maps_as_the_paper->report)},
      curves_over_t(found.maps_as_the_paper->report, "all", "true", source)};
  ReportSection plain{"Images as they are", {"Filter, then threshold."}, {best_table(report)}, {}};
  append(plain.figures, curves_over_t(report, "all", "true", source));
  ReportSection places{"Places", {"Images as they are."}, {}, {}};
  ReportSection seen{"Maps", {"Images as they are."}, {}, {}};
  for (const auto& [place, sheet] : found.maps->pictures) {
    append(places.figures, curves_over_t(report, place, "true", source));
    seen.figures.push_back({"Maps of " + place,
                            fmt::format("From above, north up: left the free cells, right the occupied ones; bright "
                                        "observable cells, dim all others; each at its t with the best F1. {}",
                                        source),
                            fmt::format("Truth and maps of {} from above by filter", place),
                            sheet,
                            {place_table(report, place)},
                            true});
  }
  ReportSection drifted{
      "With drifting poses",
      {"The same pings at dead-reckoned poses, off by 1.1 m after 20 minutes on average. Images as they "
       "are."},
      {},
      curves_over_t(report, "all", "drifted", source)};
  section.parts = {std::move(as_the_paper), std::move(plain), std::move(places), std::move(seen), std::move(drifted)};
  return section;
}

}  // namespace ensonify
