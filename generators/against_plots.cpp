#include "ensonify/generators/against_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ensonify {
namespace {

constexpr int picture_rows = 640;
constexpr int most_picture_columns = 400;
constexpr std::size_t most_points = 2000;

struct NamedSide {
  const char* name;
  const SideFigures& figures;
};
using Sides = std::array<NamedSide, 2>;

Plot speckle_plot(const Sides& sides) {
  Plot plot = titled_plot("Normalised pixels of even tiles", "pixel over its local mean", "density");
  std::vector<Series> laws;
  for (const auto& [name, side] : sides) {
    Series points{name, {}, {}, Series::Style::points}, law;
    if (side.even) {
      const Histogram& h = side.normalised;
      const auto total = static_cast<double>(std::accumulate(h.counts.begin(), h.counts.end(), std::uint64_t{0}));
      const double width = (h.high - h.low) / static_cast<double>(h.counts.size());
      const double k = side.even->fits.weibull_shape, scale = side.even->fits.weibull_scale;
      for (std::size_t i = 0; i < h.counts.size(); ++i) {
        const double x = h.low + (static_cast<double>(i) + 0.5) * width, z = x / scale;
        points.x.push_back(x);
        points.y.push_back(static_cast<double>(h.counts[i]) / total / width);
        law.x.push_back(x);
        law.y.push_back(k / scale * std::pow(z, k - 1) * std::exp(-std::pow(z, k)));
      }
      law.name = fmt::format("Weibull {:.2f}", k);
    }
    plot.series.push_back(std::move(points));
    laws.push_back(std::move(law));
  }
  for (Series& law : laws) plot.series.push_back(std::move(law));
  plot.x_range = {{0.0, 2.5}};
  return plot;
}

Plot acf_plot(const Sides& sides, const char* title, const char* x_label, Autocorrelation SpeckleFigures::*acf) {
  Plot plot = titled_plot(title, x_label, "autocorrelation");
  for (const auto& [name, side] : sides) {
    Series series{name, {}, {}};
    for (std::size_t lag = 0; lag <= most_lag && side.even; ++lag) {
      series.x.push_back(static_cast<double>(lag));
      series.y.push_back((*side.even.*acf)[lag]);
    }
    plot.series.push_back(std::move(series));
  }
  plot.y_range = {{-0.2, 1.0}};
  return plot;
}

template <typename Sums, typename Pixels>
Plot profile_plot(const Sides& sides, Plot plot, Sums LevelSums::*sums, Pixels LevelSums::*pixels) {
  for (const auto& [name, side] : sides) {
    const auto& sum = side.levels.*sums;
    Series series{name, {}, {}};
    for (std::size_t i = 0; i < sum.size(); ++i) {
      series.x.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(sum.size()));
      series.y.push_back(sum[i] / static_cast<double>((side.levels.*pixels)[i]));
    }
    plot.series.push_back(std::move(series));
  }
  plot.x_range = {{0.0, 1.0}};
  return plot;
}

Plot level_plot(const Sides& sides) {
  Plot plot = titled_plot("Grey levels of whole images", "grey level", "log10 of the share of pixels");
  for (const auto& [name, side] : sides) {
    Series series{name, {}, {}};
    for (std::size_t g = 0; g < side.levels.histogram.size(); ++g) {
      const auto count = static_cast<double>(side.levels.histogram[g]);
      series.x.push_back(static_cast<double>(g));
      series.y.push_back(count > 0 ? std::log10(count / static_cast<double>(side.levels.pixels))
                                   : std::numeric_limits<double>::quiet_NaN());
    }
    plot.series.push_back(std::move(series));
  }
  plot.x_range = {{0.0, 255.0}};
  return plot;
}

Plot pings_plot(const Sides& sides) {
  Plot plot = titled_plot("From ping to ping, all tiles", "mean grey level of the tile", "correlation of the speckle");
  for (const auto& [name, side] : sides) {
    const auto& tiles = side.ping_to_ping.tiles;
    const bool moved = !side.ping_to_ping.still.value_or(true);
    Series series{moved ? fmt::format("{}, moving", name) : name, {}, {}, Series::Style::points};
    const std::size_t step = tiles.size() / most_points + 1;
    for (std::size_t i = 0; i < tiles.size(); i += step) {
      series.x.push_back(tiles[i].mean_level);
      series.y.push_back(tiles[i].correlation);
    }
    plot.series.push_back(std::move(series));
  }
  plot.y_range = {{-0.2, 1.05}};
  return plot;
}

Plot tiles_plot(const Sides& sides) {
  Plot plot = titled_plot("Even tiles", "mean grey level of the tile", "Weibull shape");
  for (const auto& [name, side] : sides) {
    Series series{name, {}, {}, Series::Style::points};
    for (const TileFigures& tile : side.tiles) {
      series.x.push_back(tile.tile.mean_level);
      series.y.push_back(tile.speckle.fits.weibull_shape);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

void frame(Image2<std::uint8_t>& picture, const Region& r) {
  constexpr std::uint8_t white = 255;
  for (int c = r.column0; c < r.column1; ++c) picture(r.row0, c) = picture(r.row1 - 1, c) = white;
  for (int row = r.row0; row < r.row1; ++row) picture(row, r.column0) = picture(row, r.column1 - 1) = white;
}

/// The middle one of the images read, plain and with its even tiles framed; its name.
std::string add_pictures(const PingSeries& pings, const SideFigures& side,
                         std::vector<Image2<std::uint8_t>>& pictures) {
  const std::size_t middle = side.read.size() / 2;
  const GreyImage image = read_ping(pings, side.read[middle]);
  Image2<std::uint8_t> grey(image.grey.rows(), image.grey.columns());
  std::transform(image.grey.pixels().begin(), image.grey.pixels().end(), grey.pixels().begin(),
                 [](float level) { return static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F)); });
  // Beams and bins have no scale in common, so that the width is free: a pixel a beam where that is not too wide.
  const int columns = std::min(grey.columns(), most_picture_columns);
  pictures.push_back(resized(grey, picture_rows, columns));
  for (const TileFigures& t : side.tiles) {
    if (t.image == side.read[middle]) frame(grey, t.tile.region);
  }
  pictures.push_back(resized(grey, picture_rows, columns));
  return side.name + " " + side.files[middle];
}

}  // namespace

PlotSheet against_plots(const SideFigures& simulated, const SideFigures& real) {
  const Sides sides{{{"simulated", simulated}, {"real", real}}};
  PlotSheet sheet;
  sheet.plots = {speckle_plot(sides),
                 acf_plot(sides, "Across beams, even tiles", "lag [beams]", &SpeckleFigures::beam),
                 acf_plot(sides, "Along range, even tiles", "lag [range bins]", &SpeckleFigures::range),
                 tiles_plot(sides),
                 level_plot(sides),
                 profile_plot(sides, titled_plot("Over range, whole images", "share of the rows", "mean grey level"),
                              &LevelSums::range_sum, &LevelSums::range_pixels),
                 profile_plot(sides, titled_plot("Over beams, whole images", "share of the columns", "mean grey level"),
                              &LevelSums::beam_sum, &LevelSums::beam_pixels),
                 pings_plot(sides)};
  sheet.columns = 4;
  sheet.width = 1720;
  sheet.height = 680;
  return sheet;
}

ContactSheet against_pictures(const PingSeries& simulated, const SideFigures& simulated_figures, const PingSeries& real,
                              const SideFigures& real_figures) {
  ContactTile tile;
  const std::string left = add_pictures(simulated, simulated_figures, tile.pictures);
  const std::string right = add_pictures(real, real_figures, tile.pictures);
  tile.caption = "range downwards, beams to the right; each once more with its even tiles framed";
  return {fmt::format("simulated: {}; real: {}", left, right), {{"", {std::move(tile)}}}};
}

}  // namespace ensonify
