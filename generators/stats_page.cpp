#include "ensonify/generators/stats_page.hpp"

#include <fmt/format.h>

#include "ensonify/generators/stats_plots.hpp"
#include "ensonify/generators/stats_tables.hpp"
#include "ensonify/output/curve_table.hpp"

namespace ensonify {
namespace {

/// Composes figures of one dataset: what all captions and descriptions share.
class Composer {
 public:
  Composer(const DatasetStats& stats, const ReportSource& source)
      : stats_(stats),
        read_(fmt::format("{} of {} frames. {}", stats.overall.frames_read, stats.overall.frames, source.line)),
        all_(fmt::format("All {} frames. {}", stats.overall.frames, source.line)) {}

  ReportFigure from_pixels(Plot plot, const std::string& caption, std::vector<ReportTable> tables) const {
    return curves(std::move(plot), caption + " " + read_, std::move(tables));
  }

  ReportFigure from_metadata(Plot plot, const std::string& caption, std::vector<ReportTable> tables) const {
    return curves(std::move(plot), caption + " " + all_, std::move(tables));
  }

  ReportFigure frames_of(const std::string& split, ContactSheet sheet) const {
    return {
        fmt::format("Frames of {}", split),
        fmt::format("Left the raw image, right its mask; range downwards, port on the left; frames evenly spread over "
                    "each place. {}",
                    read_),
        fmt::format("Some frames of the split {}, raw beside mask, by place", split),
        std::move(sheet),
        {place_table(stats_, split)},
        true};
  }

 private:
  static ReportFigure curves(Plot plot, std::string caption, std::vector<ReportTable> tables) {
    std::string names;
    for (const Series& series : plot.series) names += (names.empty() ? "" : ", ") + series.name;
    std::string alt = fmt::format("Curves of {} over {} for {}", plot.y_label, plot.x_label, names);
    std::string title = plot.title;
    return {std::move(title), std::move(caption), std::move(alt), figure_of(std::move(plot)), std::move(tables)};
  }

  const DatasetStats& stats_;
  std::string read_, all_;
};

ReportSection splits_and_places(const DatasetStats& stats) {
  ReportSection section{"Splits and places", {}, {split_table(stats), place_table(stats, "")}, {}};
  std::string unseen;
  for (const PlaceFigures& place : stats.places) {
    if (place.figures.frames == 0) unseen += (unseen.empty() ? "" : ", ") + place.place.name;
  }
  if (!unseen.empty()) section.paragraphs.push_back("No frame shows: " + unseen + ".");
  return section;
}

ReportSection masks_and_labels(const DatasetStats& stats, const Composer& compose, StatsPlots& plots) {
  auto tables = spread_tables(stats, [](const Figures& f) { return &f.mask_share; });
  tables[0] = percentile_table(stats);
  return {"Masks and labels",
          {},
          {label_table(stats)},
          {compose.from_pixels(std::move(plots.mask_share),
                               "How much of a frame its mask covers: shares of a split's frames in equal steps.",
                               std::move(tables))}};
}

ReportSection levels_and_range(const DatasetStats& stats, const Composer& compose, StatsPlots& plots) {
  auto raw_table = curve_table(plots.raw_over_range, 3, 2), mask_table = curve_table(plots.mask_over_range, 3, 4);
  return {"Grey levels and range",
          {},
          {},
          {compose.from_pixels(std::move(plots.raw_levels),
                               "Shares of pixels at each level of the raw images (16 bits: of their upper byte).",
                               {grey_table(stats, &PixelSums::raw)}),
           compose.from_pixels(std::move(plots.clean_levels), "Shares of pixels at each level of the clean images.",
                               {grey_table(stats, &PixelSums::clean)}),
           compose.from_pixels(std::move(plots.raw_over_range), "Mean level (0 to 255) of the raw images by range.",
                               {std::move(raw_table)}),
           compose.from_pixels(std::move(plots.mask_over_range), "Share of pixels in the mask by range.",
                               {std::move(mask_table)})}};
}

const Summary* find(const std::map<std::string, Summary>& summaries, const std::string& key) {
  const auto found = summaries.find(key);
  return found == summaries.end() ? nullptr : &found->second;
}

ReportSection drawn(const char* title, const DatasetStats& stats, const Composer& compose,
                    std::vector<std::pair<std::string, Plot>>& plots,
                    std::map<std::string, Summary> Figures::*summaries, const char* caption) {
  ReportSection section{title, {}, {}, {}};
  for (auto& [key, plot] : plots) {
    const std::string name = key;
    section.figures.push_back(compose.from_metadata(
        std::move(plot), caption, spread_tables(stats, [&](const Figures& f) { return find(f.*summaries, name); })));
  }
  return section;
}

ReportSection variety(const TrainVariety& train) {
  const Variety& v = train.variety;
  return {
      "Nearly equal frames",
      {fmt::format("Of {} clean images of train, {} stand in {}{} pairs that are nearly equal (hashes at most {} bits "
                   "apart and correlation above {}); {} frames are blank.",
                   v.frames, v.frames_in_pairs, v.complete ? "" : "more than ", v.pairs, near_hash_distance,
                   near_correlation, v.blank)},
      train.closest.empty() ? std::vector<ReportTable>{} : std::vector<ReportTable>{pair_table(train)},
      {}};
}

}  // namespace

ReportPage stats_page(const DatasetStats& stats, const ReportSource& source) {
  const Composer compose(stats, source);
  StatsPlots plots = plots_of(stats);
  ReportPage page{fmt::format("Dataset {}", stats.name),
                  fmt::format("{}: {} frames of {} places, {} of them read for what comes from pixels.", stats.title,
                              stats.overall.frames, stats.places.size(), stats.overall.frames_read),
                  source.facts,
                  {splits_and_places(stats)}};
  if (!stats.contact_sheets.empty()) {
    ReportSection frames{"Frames", {}, {}, {}};
    for (const auto& [split, sheet] : stats.contact_sheets) frames.figures.push_back(compose.frames_of(split, sheet));
    page.sections.push_back(std::move(frames));
  }
  page.sections.push_back(masks_and_labels(stats, compose, plots));
  page.sections.push_back(levels_and_range(stats, compose, plots));
  page.sections.push_back(drawn("Poses", stats, compose, plots.poses, &Figures::poses,
                                "True poses of the sonar: shares of a split's frames in equal steps."));
  if (!plots.sampled.empty()) {
    page.sections.push_back(drawn("Sampled parameters", stats, compose, plots.sampled, &Figures::sampled,
                                  "What the recipe draws for each frame: shares of a split's frames in equal steps."));
  }
  if (stats.variety) page.sections.push_back(variety(*stats.variety));
  return page;
}

}  // namespace ensonify
