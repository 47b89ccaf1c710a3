#include "ensonify/generators/stats_plots.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace ensonify {
namespace {

constexpr std::size_t most_sampled_plots = 12;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Shares of all values in a step, as a line of steps.
Series steps(const std::string& name, const Histogram& h) {
  Series series{name, {}, {}};
  const auto total = static_cast<double>(std::accumulate(h.counts.begin(), h.counts.end(), std::uint64_t{0}));
  const double width = (h.high - h.low) / static_cast<double>(h.counts.size());
  for (std::size_t i = 0; i < h.counts.size() && total > 0; ++i) {
    for (const int end : {0, 1}) {
      series.x.push_back(h.low + width * static_cast<double>(i + end));
      series.y.push_back(static_cast<double>(h.counts[i]) / total);
    }
  }
  return series;
}

template <typename SummaryOf>
Plot spread_plot(const DatasetStats& stats, Plot plot, const SummaryOf& summary_of) {
  for (const auto& [split, figures] : stats.splits) {
    const Summary* summary = summary_of(figures);
    if (!summary || summary->count == 0) continue;
    const Histogram& h = summary->histogram;
    if (h.high > h.low) {
      plot.series.push_back(steps(split, h));
    } else {  // one value: a line where it stands
      plot.series.push_back({split, {h.low, h.low}, {0, 1}});
      plot.x_range = {{h.low - 1, h.low + 1}};
    }
  }
  return plot;
}

Plot grey_plot(const DatasetStats& stats, const char* title, std::array<std::uint64_t, 256> PixelSums::*levels) {
  Plot plot = titled_plot(title, "grey level", "log10 of the share of pixels");
  for (const auto& [split, figures] : stats.splits) {
    const auto& counts = figures.pixels.*levels;
    const auto total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
    Series series{split, {}, {}};
    for (std::size_t g = 0; g < counts.size(); ++g) {
      series.x.push_back(static_cast<double>(g));
      series.y.push_back(counts[g] > 0 ? std::log10(static_cast<double>(counts[g]) / total) : nothing);
    }
    plot.series.push_back(std::move(series));
  }
  plot.x_range = {{0.0, 255.0}};
  return plot;
}

Plot range_plot(const DatasetStats& stats, Plot plot, std::vector<std::uint64_t> PixelSums::*sum, double unit) {
  for (const auto& [split, figures] : stats.splits) {
    const auto& pixels = figures.pixels.bin_pixels;
    Series series{split, {}, {}};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double centre = (static_cast<double>(i) + 0.5) / stats.bins.bins;
      series.x.push_back(stats.bins.min_m + centre * (stats.bins.max_m - stats.bins.min_m));
      series.y.push_back(pixels[i] > 0
                             ? static_cast<double>((figures.pixels.*sum)[i]) / unit / static_cast<double>(pixels[i])
                             : nothing);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

const Summary* find(const std::map<std::string, Summary>& summaries, const std::string& key) {
  const auto found = summaries.find(key);
  return found == summaries.end() ? nullptr : &found->second;
}

}  // namespace

StatsPlots plots_of(const DatasetStats& stats) {
  StatsPlots plots;
  plots.mask_share = spread_plot(stats, titled_plot("Mask share", "share of the frame's pixels", "share of frames"),
                                 [](const Figures& f) { return &f.mask_share; });
  plots.raw_levels = grey_plot(stats, "Grey levels of raw", &PixelSums::raw);
  plots.clean_levels = grey_plot(stats, "Grey levels of clean", &PixelSums::clean);
  plots.raw_over_range =
      range_plot(stats, titled_plot("Raw over range", "range [m]", "mean grey level"), &PixelSums::bin_raw, 257);
  plots.mask_over_range =
      range_plot(stats, titled_plot("Mask over range", "range [m]", "share of pixels"), &PixelSums::bin_mask, 1);
  for (const auto& [key, label] : {std::pair{"depth_m", "depth [m]"},
                                   {"roll_deg", "roll [deg]"},
                                   {"pitch_deg", "pitch, nose down [deg]"},
                                   {"yaw_deg", "yaw [deg]"}}) {
    const std::string name = label;
    std::string title = name.substr(0, name.find_first_of(",["));
    while (title.ends_with(' ')) title.pop_back();
    title.front() = static_cast<char>(std::toupper(title.front()));
    plots.poses.emplace_back(key, spread_plot(stats, titled_plot(title, name, "share of frames"),
                                              [&key = key](const Figures& f) { return find(f.poses, key); }));
  }
  for (const auto& [key, summary] : stats.overall.sampled) {
    if (plots.sampled.size() >= most_sampled_plots) break;
    plots.sampled.emplace_back(key, spread_plot(stats, titled_plot("Sampled: " + key, key, "share of frames"),
                                                [&key = key](const Figures& f) { return find(f.sampled, key); }));
  }
  return plots;
}

PlotSheet stats_plots(const DatasetStats& stats) {
  StatsPlots plots = plots_of(stats);
  PlotSheet sheet;
  sheet.plots = {std::move(plots.mask_share), std::move(plots.raw_levels), std::move(plots.clean_levels),
                 std::move(plots.raw_over_range), std::move(plots.mask_over_range)};
  for (auto* named : {&plots.poses, &plots.sampled}) {
    for (auto& [key, plot] : *named) sheet.plots.push_back(std::move(plot));
  }
  sheet.columns = 3;
  const int rows = (static_cast<int>(sheet.plots.size()) + sheet.columns - 1) / sheet.columns;
  sheet.width = 1350;
  sheet.height = 310 * rows;
  return sheet;
}

}  // namespace ensonify
