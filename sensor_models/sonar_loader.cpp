#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ensonify/config/reader.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {
namespace {

constexpr int max_beams = 4096;
constexpr int max_bins = 16384;
constexpr int max_pixels = 1 << 24;  // a frame takes some 50 bytes a pixel while it is made
constexpr double max_gap_widths = 3;
constexpr Limits fan_width_deg{0.01, 179.0};

Shading read_shading(Reader& reader, std::string_view key) {
  static const std::map<std::string, Shading> names{{"uniform", Shading::uniform},
                                                    {"hann", Shading::hann},
                                                    {"hamming", Shading::hamming},
                                                    {"gaussian", Shading::gaussian},
                                                    {"box", Shading::box}};
  std::vector<std::string> choices;
  for (const auto& [name, value] : names) choices.push_back(name);
  return names.at(reader.choice(key, choices));
}

/// The cell of a beam reaches halfway to its neighbours: without one it has no width in maps, views and what is
/// observed.
void check_beam_count(const Reader& beams, std::string_view key, std::size_t count) {
  if (count >= 2 && count <= max_beams) return;
  beams.fail(key,
             fmt::format("must give 2 to {} beams, not {}: a beam's cell reaches halfway to the next one; in place of "
                         "a lone beam give two, half its width apart",
                         max_beams, count));
}

std::vector<double> read_beams(Reader beams) {
  const std::string spacing = beams.choice("spacing", {"uniform_angle", "uniform_sine", "listed"});
  std::vector<double> azimuth;
  if (spacing == "listed") {
    azimuth = beams.numbers("azimuth_deg", -1, {-89.5, 89.5});
    check_beam_count(beams, "azimuth_deg", azimuth.size());
    std::transform(azimuth.begin(), azimuth.end(), azimuth.begin(), radians);
    if (azimuth.front() < azimuth.back()) std::reverse(azimuth.begin(), azimuth.end());
    if (!std::is_sorted(azimuth.rbegin(), azimuth.rend()) ||
        std::adjacent_find(azimuth.begin(), azimuth.end()) != azimuth.end()) {
      beams.fail("azimuth_deg", "must rise or fall strictly");
    }
  } else {
    const int count = beams.integer("count", 0, max_beams);
    check_beam_count(beams, "count", static_cast<std::size_t>(count));
    const double fov = beams.angle_deg("azimuth_fov_deg", fan_width_deg);
    azimuth = spacing == "uniform_sine" ? uniform_sine_beams(count, fov) : uniform_angle_beams(count, fov);
  }
  beams.finish();
  return azimuth;
}

void read_range(Reader range, const RangeWindow& window, SonarModel& sonar) {
  sonar.instrument_range_min_m = range.number("min_m", {0.0, 1000.0});
  sonar.instrument_range_max_m = range.number("max_m", {std::max(sonar.instrument_range_min_m, 1e-3), 1000.0});
  sonar.native_bin_m = range.number("native_bin_m", {1e-4, 1.0});
  const double default_max_m = range.number_or("default_max_m", sonar.instrument_range_max_m, positive);
  const int default_bins = range.integer_or("default_bins", 0, 0, max_bins);
  range.finish();

  SonarGeometry& g = sonar.geometry;
  g.range_min_m = window.range_min_m.value_or(sonar.instrument_range_min_m);
  g.range_max_m = window.range_max_m.value_or(default_max_m);
  if (g.range_min_m < sonar.instrument_range_min_m || g.range_max_m > sonar.instrument_range_max_m ||
      !(g.range_min_m < g.range_max_m)) {
    range.fail("", fmt::format("the range window {} to {} m must lie within the instrument's {} to {} m", g.range_min_m,
                               g.range_max_m, sonar.instrument_range_min_m, sonar.instrument_range_max_m));
  }
  g.range_bins = window.range_bins.value_or(default_bins);
  if (g.range_bins == 0) {
    g.range_bins = static_cast<int>((g.range_max_m - g.range_min_m) / sonar.native_bin_m + 1e-9);
    g.range_max_m = g.range_min_m + g.range_bins * sonar.native_bin_m;
  }
  if (g.range_bins < 1 || g.range_bins > max_bins) {
    range.fail("", fmt::format("the range window gives {} bins; it must be 1 to {}", g.range_bins, max_bins));
  }
  if (g.range_bins * g.beams() > max_pixels) {
    range.fail("", fmt::format("{} bins x {} beams are more than the {} pixels that an image may have; ask for fewer "
                               "bins (range_bins) or a shorter window",
                               g.range_bins, g.beams(), max_pixels));
  }
}

/// Rays fill the cell of a beam evenly, so that wide gaps between narrow beams would be heard as if they were not
/// there.
void check_gaps(const Reader& pattern, const SonarModel& sonar) {
  const auto& azimuth = sonar.geometry.beam_azimuth_rad;
  const BeamGap gap = widest_gap(azimuth, sonar.receive_azimuth.width_rad());
  if (gap.widths <= max_gap_widths) return;
  const auto b = static_cast<std::size_t>(gap.after_beam);
  pattern.fail(
      "azimuth_width_deg",
      fmt::format("the beams at {:.4g} and {:.4g} deg lie {:.3g} widths apart; it must be at most {}, because a "
                  "beam hears all of its cell, which reaches halfway to the next beam, at full gain: give more "
                  "beams or wider ones",
                  degrees(azimuth[b]), degrees(azimuth[b + 1]), gap.widths, max_gap_widths));
}

void read_pattern(Reader pattern, SonarModel& sonar) {
  sonar.receive_azimuth =
      Aperture(read_shading(pattern, "azimuth_shading"), pattern.angle_deg("azimuth_width_deg", fan_width_deg));
  sonar.geometry.elevation_fov_rad = pattern.angle_deg("elevation_fov_deg", {0.01, 120.0});
  sonar.elevation = Aperture(read_shading(pattern, "elevation_shading"), sonar.geometry.elevation_fov_rad);
  sonar.fan_edge_db = pattern.number_or("fan_edge_db", 0.0, {0.0, 60.0});
  pattern.finish();
  check_gaps(pattern, sonar);
}

/// Images are computed in single precision: a gain beyond it turns silence into NaN.
void check_gain(const Reader& receive, const SonarModel& sonar) {
  const SonarGeometry& g = sonar.geometry;
  for (const int bin : {0, g.range_bins - 1}) {
    const double range_m = g.bin_centre_m(bin);
    const double gain = gain_db(sonar, range_m);
    if (std::abs(gain) <= max_gain_db) continue;
    receive.fail(
        gain > 0 ? "tvg_absorption_db_per_m" : "saturation_level_db",
        fmt::format("at {:.4g} m, within the window, source_level_db {} + tvg_spreading_db {} log10(r) + 2 "
                    "tvg_absorption_db_per_m {} r - saturation_level_db {} gives a gain of {:.0f} dB; it must "
                    "lie in [{}, {}] dB: {}",
                    range_m, sonar.source_level_db, sonar.receive.tvg_spreading_db,
                    sonar.receive.tvg_absorption_db_per_m, sonar.receive.saturation_level_db, gain, -max_gain_db,
                    max_gain_db, gain > 0 ? "lower the TVG or shorten the range window" : "lower saturation_level_db"));
  }
}

void read_receive(Reader receive, SonarModel& sonar) {
  ReceiveChain& chain = sonar.receive;
  chain.tvg_spreading_db = receive.number("tvg_spreading_db", {0.0, 60.0});
  chain.tvg_absorption_db_per_m = receive.number("tvg_absorption_db_per_m", {0.0, 10.0});
  chain.saturation_level_db = receive.number("saturation_level_db", {0.0, 400.0});
  chain.gamma = receive.number("gamma", {0.05, 4.0});
  chain.bits = receive.integer_or("bits", 8, 8, 16);
  if (chain.bits != 8 && chain.bits != 16) receive.fail("bits", "must be 8 or 16");
  receive.finish();
  check_gain(receive, sonar);
}

}  // namespace

SonarModel load_sonar(const ConfigSource& source, const RangeWindow& window) {
  Reader file = open_config("sensor_models", source);
  SonarModel sonar;
  sonar.name = file.text("name");
  sonar.title = file.text("title");
  sonar.frequency_hz = file.number("frequency_hz", {1e4, 1e7});
  sonar.bandwidth_hz = file.number("bandwidth_hz", {1e2, 5e6});
  if (sonar.bandwidth_hz > sonar.frequency_hz) {
    file.fail("bandwidth_hz", fmt::format("must be at most frequency_hz, {:g}", sonar.frequency_hz));
  }
  sonar.source_level_db = file.number("source_level_db", {100.0, 260.0});
  sonar.ping_rate_hz = file.number("ping_rate_hz", {0.01, 1000.0});
  sonar.geometry.beam_azimuth_rad = read_beams(file.child("beams"));
  read_range(file.child("range"), window, sonar);
  read_pattern(file.child("pattern"), sonar);
  read_receive(file.child("receive"), sonar);
  if (file.has("rays")) {
    Reader rays = file.child("rays");
    sonar.rays.azimuth_rays_per_beam = rays.integer_or("azimuth_per_beam", 0, 0, 64);
    sonar.rays.elevation_rays = rays.integer_or("elevation", 0, 0, 8192);
    rays.finish();
  }
  if (file.has("unverified")) sonar.unverified = file.texts("unverified");
  file.finish();
  return sonar;
}

}  // namespace ensonify
