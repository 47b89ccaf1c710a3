#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "ensonify/cli/arguments.hpp"
#include "ensonify/cli/commands.hpp"
#include "ensonify/cli/signals.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/plot.hpp"
#include "ensonify/scenes/water.hpp"
#include "ensonify/sensor_models/fan_pattern.hpp"
#include "ensonify/sensor_models/point_spread.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify::cli {
namespace {

constexpr double floor_db = -60;

double decibel(double power) { return std::max(floor_db, 10 * std::log10(std::max(power, 1e-12))); }

/// -3 dB width of a beam that points to azimuth_rad: the aperture's width in sin(theta), so 1 / cos(theta) wider.
double beam_width_rad(const SonarModel& sonar, double azimuth_rad) {
  const double half = std::sin(0.5 * sonar.receive_azimuth.width_rad());
  const auto edge = [&](double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)); };
  return edge(std::sin(azimuth_rad) + half) - edge(std::sin(azimuth_rad) - half);
}

/// Angle to the next beam; for the last one, to the one before.
double beam_step_rad(const SonarGeometry& g, int beam) {
  if (g.beams() < 2) return 0;
  const auto b = static_cast<std::size_t>(std::min(beam, g.beams() - 2));
  return g.beam_azimuth_rad[b] - g.beam_azimuth_rad[b + 1];
}

std::string beam_line(const SonarModel& sonar, int beam, const char* format) {
  const double azimuth = sonar.geometry.beam_azimuth_rad[static_cast<std::size_t>(beam)];
  return fmt::format(fmt::runtime(format), beam, degrees(azimuth), degrees(beam_step_rad(sonar.geometry, beam)),
                     degrees(beam_width_rad(sonar, azimuth)));
}

/// The outermost beam is wider than the one in the middle.
Plot azimuth_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Receive beams", "off the beam's axis [deg]", "[dB]");
  plot.y_range = {{floor_db, 3.0}};
  const auto& beams = sonar.geometry.beam_azimuth_rad;
  const double reach = 5 * sonar.receive_azimuth.width_rad();
  for (const std::size_t b : {std::size_t{0}, beams.size() / 2}) {
    Series series{fmt::format("beam {}", b), {}, {}};
    for (int i = -500; i <= 500; ++i) {
      const double off = reach * i / 500;
      series.x.push_back(degrees(off));
      series.y.push_back(decibel(sonar.receive_azimuth.power(std::sin(beams[b] + off) - std::sin(beams[b]))));
    }
    plot.series.push_back(series);
  }
  return plot;
}

Plot elevation_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Elevation, two ways", "elevation [deg]", "[dB]");
  plot.y_range = {{floor_db, 3.0}};
  Series series;
  const double edge = std::min(2.2 * sonar.geometry.elevation_fov_rad, radians(90.0));
  for (int i = -400; i <= 400; ++i) {
    const double elevation = edge * i / 400;
    series.x.push_back(degrees(elevation));
    series.y.push_back(2 * decibel(sonar.elevation.power(std::sin(elevation))));
  }
  plot.series.push_back(series);
  return plot;
}

Plot beam_table_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Beam table", "beam (port first)", "[deg]");
  Series step{"to the next beam", {}, {}}, width{"-3 dB width", {}, {}};
  for (int b = 0; b < sonar.geometry.beams(); ++b) {
    step.x.push_back(b);
    width.x.push_back(b);
    step.y.push_back(degrees(beam_step_rad(sonar.geometry, b)));
    width.y.push_back(degrees(beam_width_rad(sonar, sonar.geometry.beam_azimuth_rad[static_cast<std::size_t>(b)])));
  }
  const double top = 1.2 * std::max(*std::max_element(step.y.begin(), step.y.end()),
                                    *std::max_element(width.y.begin(), width.y.end()));
  plot.y_range = {{0.0, top}};
  plot.series = {step, width};
  return plot;
}

Plot range_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Level of a target over range", "range [m]", "[dB re full scale]");
  const std::vector<float> gains = row_gains(sonar);
  const double absorption_db_per_m = ensonify::absorption_db_per_m(Water{}, sonar.frequency_hz);
  Series point{"sphere of 0.5 m radius", {}, {}}, bed{"sea bed, mu -20 dB, at 20 deg", {}, {}};
  const double cell_sr = sonar.receive_azimuth.width_rad();
  for (int k = 0; k < sonar.geometry.range_bins; ++k) {
    const double r = sonar.geometry.bin_centre_m(k);
    const double way_db = -40 * std::log10(r) - 2 * absorption_db_per_m * r;
    const double gain_db = 10 * std::log10(gains[static_cast<std::size_t>(k)]);
    const double sine = std::sin(radians(20.0)), cosine = std::cos(radians(20.0));
    const double area_m2 = r * cell_sr * sonar.geometry.bin_size_m() / cosine;
    point.x.push_back(r);
    point.y.push_back(20 * std::log10(0.5 / 2) + way_db + gain_db);
    bed.x.push_back(r);
    bed.y.push_back(-20 + 20 * std::log10(sine) + 10 * std::log10(area_m2) + way_db + gain_db);
  }
  plot.series = {point, bed};
  return plot;
}

Plot fan_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Loss across the fan, two ways", "azimuth [deg]", "[dB]");
  const auto& beams = sonar.geometry.beam_azimuth_rad;
  const FanPattern pattern(sonar);
  Series series;
  for (const double azimuth : beams) {
    series.x.push_back(degrees(azimuth));
    series.y.push_back(10.0 * std::log10(pattern(azimuth)));
  }
  plot.y_range = {{-std::max(6.0, 1.5 * sonar.fan_edge_db), 1.0}};
  plot.series.push_back(series);
  return plot;
}

/// Of the echo's energy in the bins about its own.
Plot pulse_plot(const SonarModel& sonar) {
  Plot plot = titled_plot("Pulse", "bins off the echo's", "share of the energy");
  const std::vector<float> weights = PointSpread(sonar).range_weights();
  Series series{"", {}, {}, Series::Style::bars};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    series.x.push_back(static_cast<double>(i) - static_cast<double>(weights.size() / 2));
    series.y.push_back(weights[i]);
  }
  plot.y_range = {{0.0, 1.1 * *std::max_element(weights.begin(), weights.end())}};
  plot.series.push_back(series);
  return plot;
}

struct Arguments {
  std::string sonar;
  std::string out;
};

void show(const Arguments& a) {
  const SonarModel sonar = load_sonar(a.sonar);
  const int beams = sonar.geometry.beams();
  fmt::print("{}: {}\n  beam  azimuth [deg]  to next [deg]  width [deg]\n", sonar.name, sonar.title);
  constexpr int lines = 16;
  int before = -1;
  for (int i = 0; i <= lines; ++i) {
    const int beam = (beams - 1) * i / lines;
    if (beam != before) fmt::print("{}\n", beam_line(sonar, beam, "{:6} {:14.3f} {:14.3f} {:12.3f}"));
    before = beam;
  }
  if (!sonar.unverified.empty()) fmt::print("  unverified: {}\n", fmt::join(sonar.unverified, ", "));
  if (a.out.empty()) return;
  std::string table = "beam,azimuth_deg,to_next_deg,width_deg\n";
  for (int b = 0; b < beams; ++b) table += beam_line(sonar, b, "{},{:.6f},{:.6f},{:.6f}\n");
  const std::filesystem::path out = a.out;
  const PlotSheet sheet{{azimuth_plot(sonar), elevation_plot(sonar), fan_plot(sonar), beam_table_plot(sonar),
                         pulse_plot(sonar), range_plot(sonar)},
                        3,
                        1200,
                        620};
  const std::vector<std::uint8_t> picture = draw_plots(sheet);
  write_unbroken(out, [&] {
    write_file(out / "beams.csv", table);
    write_file(out / "sonar.png", picture);
  });
  fmt::print("sonar.png beams.csv in {}\n", a.out);
}

}  // namespace

void add_sonar_show(CLI::App& sonar_command) {
  auto* command = sonar_command.add_subcommand("show", "Print an instrument's beam table and draw its patterns");
  auto a = std::make_shared<Arguments>();
  command->add_option("SONAR", a->sonar, "Sonar YAML or bundled name")->required();
  command->add_option("--out", a->out, "Folder for sonar.png and beams.csv, all beams")->check(some_path());
  command->footer("Example:\n  ensonify sonar show oculus_m750d_hf --out out/m750d");
  command->callback([a] { show(*a); });
}

}  // namespace ensonify::cli
