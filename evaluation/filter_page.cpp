#include "ensonify/evaluation/filter_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/filter_figures.hpp"

namespace ensonify {
namespace {

bool has_ghosts(const FilterReport& report) {
  return std::ranges::any_of(report.rows, [](const auto& row) { return std::isfinite(row.ghosts_removed.value); });
}

ReportTable times_table(const FilterReport& report) {
  ReportTable table{"Median time of a frame [ms], on one core", {"filter", "preset"}, {}, 2, true};
  const std::vector<std::string> scenes = scenes_of(report);
  table.columns.emplace_back("all");
  table.columns.insert(table.columns.end(), scenes.begin(), scenes.end());
  for (const FilterScores& row : report.rows) {
    if (row.scene == "all") table.rows.push_back({row.filter, row.preset});
    table.rows.back().push_back(fixed(row.time_ms, 2));  // a filter's scenes follow its "all"
  }
  return table;
}

ReportSection masks(const FilterReport& report, const std::string& tail) {
  const std::string pooled = " Of the pooled pixels of all frames; lines: 95 % interval by bootstrap over frames. ";
  ReportSection section{"Masks", {}, {}, {}};
  section.figures = {
      score_figure(report, {"IoU of the mask", "IoU", &FilterScores::iou, 3},
                   "Pixels in both masks over pixels in either, at the threshold t chosen on val." + pooled + tail),
      score_figure(report, {"Filtered image under its own mask", "PSNR [dB]", &FilterScores::gated_psnr_db, 2},
                   "The filtered image where the filter's mask is set, 0 elsewhere, against the clean twin. Mean over "
                   "frames; lines: 95 % interval (Student). " +
                       tail),
      score_figure(
          report, {"Raw image under the filter's mask", "PSNR [dB]", &FilterScores::masked_psnr_db, 2},
          "The raw image where the filter's mask is set, 0 elsewhere, against the clean twin. Mean over frames; "
          "lines: 95 % interval (Student). " +
              tail)};
  if (has_ghosts(report)) {
    section.figures.push_back(score_figure(
        report, {"Ghosts removed", "share of multipath energy", &FilterScores::ghosts_removed, 3},
        fmt::format("Energy of multipath below the threshold that keeps {:g} % of the direct echoes of these frames.",
                    100 * kept_beside_ghosts) +
            pooled + tail));
  }
  for (const std::string& preset : presets_of(report)) {
    if (!preset.empty()) section.figures.push_back(precision_figure(report, preset, tail));
  }
  return section;
}

}  // namespace

ReportPage filter_page(const FilterReport& report, ContactSheet frames, const ReportSource& source) {
  const std::string tail = fmt::format("{} frames of test. {}", report.test_frames, source.line);
  const std::string means = " Mean over frames; lines: 95 % interval (Student). ";
  ReportPage page{fmt::format("Filters on {}", report.dataset),
                  fmt::format("{} frames of the split test are scored against their clean twins and true masks; the "
                              "thresholds of masks were chosen on {} frames of val.",
                              report.test_frames, report.val_frames),
                  source.facts,
                  {}};
  page.sections.push_back({"Scores",
                           {"raw is the image as it is; truth_mask is the true mask applied to it: what no mask can "
                            "surpass. Presets: paper "
                            "holds the published parameters, tuned those that gave the best masks on other data."},
                           {score_table(report, "all")},
                           {}});
  page.sections.push_back(
      {"Likeness to the clean twin",
       {},
       {},
       {score_figure(report, {"PSNR", "PSNR [dB]", &FilterScores::psnr_db, 2},
                     "10 log10(255² / mean squared difference), the higher the better." + means + tail),
        score_figure(report, {"SSIM", "SSIM", &FilterScores::ssim, 3},
                     "Structural similarity (Wang et al. 2004)." + means + tail),
        score_figure(report, {"Edges kept", "correlation", &FilterScores::edge_preservation, 3},
                     "Correlation of the Laplacians of both images (Sattar et al. 1997)." + means + tail)}});
  page.sections.push_back(masks(report, tail));
  ReportSection scenes{"Scenes", {}, {}, {}};
  for (const std::string& scene : scenes_of(report)) scenes.tables.push_back(score_table(report, scene));
  page.sections.push_back(std::move(scenes));
  ReportTable shown = score_table(report, "all");
  shown.caption = "Scores of the filters shown";
  shown.open = false;
  page.sections.push_back(
      {"Frames",
       {},
       {},
       {{"A frame of every scene through all filters",
         "The middle frame of each place of test; range downwards, port on the left. " + source.line,
         "The same frames, raw, clean, mask and filtered by every filter",
         std::move(frames),
         {std::move(shown)},
         true}}});
  page.sections.push_back(
      {"Times",
       {"Of the filter alone. These are the only numbers of this page that differ from run to run."},
       {times_table(report)},
       {}});
  return page;
}

}  // namespace ensonify
