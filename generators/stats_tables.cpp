#include "ensonify/generators/stats_tables.hpp"

#include <fmt/format.h>

#include <numeric>

namespace ensonify {
namespace {

template <typename Counts>
double sum_of(const Counts& counts) {
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
}

/// The figures of every split, then of all.
std::vector<std::pair<std::string, const Figures*>> groups_of(const DatasetStats& stats) {
  std::vector<std::pair<std::string, const Figures*>> groups;
  for (const auto& [split, figures] : stats.splits) groups.emplace_back(split, &figures);
  groups.emplace_back("all", &stats.overall);
  return groups;
}

}  // namespace

ReportTable split_table(const DatasetStats& stats) {
  ReportTable table{"Splits",
                    {"split", "frames", "read", "mask share, median [%]", "5 % of frames below [%]", "5 % above [%]",
                     "frames without echo [%]"},
                    {},
                    1};
  for (const auto& [name, f] : groups_of(stats)) {
    const double blank = static_cast<double>(f->pixels.without_echo) / f->frames_read;
    table.rows.push_back({name, std::to_string(f->frames), std::to_string(f->frames_read),
                          percent(f->mask_share_percentiles[3], 2), percent(f->mask_share_percentiles[1], 2),
                          percent(f->mask_share_percentiles[5], 2), percent(blank)});
  }
  return table;
}

ReportTable place_table(const DatasetStats& stats, const std::string& split) {
  ReportTable table{
      split.empty() ? "Places" : fmt::format("Places of {}", split),
      {"place", "scene", "split", "layout", "frames", "mask share, median [%]", "way [m]", "drift at its end [m]"},
      {},
      3};
  for (const PlaceFigures& place : stats.places) {
    if (!split.empty() && place.split != split) continue;
    const Figures& f = place.figures;
    table.rows.push_back({place.place.name, place.place.scene, place.split, std::to_string(place.place.layout),
                          std::to_string(f.frames), f.frames_read > 0 ? percent(f.mask_share_percentiles[3], 2) : "–",
                          place.way ? fixed(place.way->length_m, 2) : "–",
                          place.way ? fixed(place.way->drift_m, 3) : "–"});
  }
  return table;
}

ReportTable percentile_table(const DatasetStats& stats) {
  ReportTable table{"Mask share [% of a frame's pixels]: so many percent of the frames have less", {"split"}, {}, 1};
  for (const int percents : mask_share_percents) table.columns.push_back(fmt::format("{} %", percents));
  for (const auto& [name, f] : groups_of(stats)) {
    std::vector<std::string> row{name};
    for (const double share : f->mask_share_percentiles) row.push_back(percent(share, 2));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable label_table(const DatasetStats& stats) {
  ReportTable table{
      "Pixels by label [%]", {"split", "water", "direct echo", "multipath", "sidelobe", "shadow", "outside"}, {}, 1};
  for (const auto& [name, f] : groups_of(stats)) {
    std::vector<std::string> row{name};
    for (const std::uint64_t pixels : f->pixels.labels) {
      row.push_back(percent(static_cast<double>(pixels) / sum_of(f->pixels.labels), 3));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable grey_table(const DatasetStats& stats, std::array<std::uint64_t, 256> PixelSums::*levels) {
  ReportTable table{"Share of pixels [%] at each grey level", {"grey level"}, {}, 1};
  for (const auto& [split, figures] : stats.splits) table.columns.push_back(split);
  for (std::size_t g = 0; g < 256; ++g) {
    std::vector<std::string> row{std::to_string(g)};
    for (const auto& [split, figures] : stats.splits) {
      const auto& counts = figures.pixels.*levels;
      row.push_back(percent(static_cast<double>(counts[g]) / sum_of(counts), 4));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable pair_table(const TrainVariety& train) {
  ReportTable table{"The closest pairs",
                    {"frames", "places", "correlation", "hash distance [bits]", "apart [m]", "turned [°]"},
                    {},
                    2};
  for (const TrainVariety::Pair& pair : train.closest) {
    table.rows.push_back({fmt::format("{:06}, {:06}", pair.a, pair.b),
                          pair.place_a == pair.place_b ? pair.place_a : pair.place_a + ", " + pair.place_b,
                          fixed(pair.correlation, 4), std::to_string(pair.distance), fixed(pair.apart_m, 3),
                          fixed(pair.turned_deg, 1)});
  }
  return table;
}

std::vector<ReportTable> spread_tables(const DatasetStats& stats, const SummaryOf& summary_of) {
  ReportTable summaries{"Least, mean and greatest", {"split", "frames", "least", "mean", "greatest"}, {}, 1};
  ReportTable steps{"Share of frames [%] in each step", {"from", "to"}, {}, 2};
  std::vector<const Histogram*> histograms;
  for (const auto& [split, figures] : stats.splits) {
    const Summary* summary = summary_of(figures);
    if (!summary || summary->count == 0) continue;
    summaries.rows.push_back({split, std::to_string(summary->count), significant(summary->min, 4),
                              significant(summary->mean, 4), significant(summary->max, 4)});
    steps.columns.push_back(split);
    histograms.push_back(&summary->histogram);
  }
  if (histograms.empty() || histograms[0]->high <= histograms[0]->low) return {summaries};
  const Histogram& edges = *histograms[0];  // the same of all splits
  const double width = (edges.high - edges.low) / static_cast<double>(edges.counts.size());
  for (std::size_t i = 0; i < edges.counts.size(); ++i) {
    const auto at = static_cast<double>(i);
    std::vector<std::string> row{significant(edges.low + width * at, 4), significant(edges.low + width * (at + 1), 4)};
    for (const Histogram* h : histograms) {
      row.push_back(percent(static_cast<double>(h->counts.at(i)) / sum_of(h->counts), 2));
    }
    steps.rows.push_back(std::move(row));
  }
  return {summaries, steps};
}

}  // namespace ensonify
