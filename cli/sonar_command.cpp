#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "ensonify/cli/commands.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sim/ray_fan.hpp"

namespace ensonify::cli {
namespace {

/// Beams at the -3 dB width of their neighbours are what sonars have (DIDSON: 1.02); halfway over this gap one hears 7
/// dB less of what lies there.
constexpr double told_gap_widths = 1.5;

void list() {
  for (const std::string& name : library_names("sensor_models"))
    fmt::print("{:<22} {}\n", name, load_sonar(name).title);
}

/// The table of docs/instruments.md.
void list_markdown() {
  fmt::print(
      "| name | what | kHz | beams | fan [deg] | beam [deg] | range [m] | bin [mm] | window [m] | unverified |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& name : library_names("sensor_models")) {
    const SonarModel s = load_sonar(name);
    const SonarGeometry& g = s.geometry;
    fmt::print("| `{}` | {} | {:.0f} | {} | {:.0f} x {:.0f} | {:.2f} | {} to {} | {:.2f} | {} to {} | {} |\n", name,
               s.title.substr(0, s.title.find(',')), s.frequency_hz / 1e3, g.beams(),
               degrees(g.beam_azimuth_rad.front() - g.beam_azimuth_rad.back()), degrees(g.elevation_fov_rad),
               degrees(s.receive_azimuth.width_rad()), s.instrument_range_min_m, s.instrument_range_max_m,
               1e3 * s.native_bin_m, g.range_min_m, g.range_max_m, fmt::join(s.unverified, ", "));
  }
}

void check(const std::string& path_or_name) {
  const SonarModel sonar = load_sonar(path_or_name);
  const SonarGeometry& g = sonar.geometry;
  const RayFan fan(sonar);
  const double azimuth_deg = degrees(g.beam_azimuth_rad.front() - g.beam_azimuth_rad.back());
  const double arc_deg = degrees(2.0 * fan.rows[0].elevation_rad.back());
  fmt::print(
      "{}: {}\n"
      "  {:.0f} kHz, {:.0f} kHz bandwidth, source level {} dB, {} Hz\n"
      "  {} beams from {:.2f} to {:.2f} deg, {:.2f} deg wide; {:.1f} deg in elevation\n"
      "  {} bins of {:.2f} mm, {} to {:.3f} m (instrument: {} to {} m)\n"
      "  {} x {} rays over {:.1f} deg of elevation, {:.2f} x {:.2f} deg apart\n",
      sonar.name, sonar.title, sonar.frequency_hz / 1e3, sonar.bandwidth_hz / 1e3, sonar.source_level_db,
      sonar.ping_rate_hz, g.beams(), degrees(g.beam_azimuth_rad.front()), degrees(g.beam_azimuth_rad.back()),
      degrees(sonar.receive_azimuth.width_rad()), degrees(g.elevation_fov_rad), g.range_bins, 1e3 * g.bin_size_m(),
      g.range_min_m, g.range_max_m, sonar.instrument_range_min_m, sonar.instrument_range_max_m, fan.columns.size(),
      fan.elevation_rays, arc_deg, azimuth_deg / (static_cast<double>(fan.columns.size()) - 1),
      arc_deg / (fan.elevation_rays - 1));
  const double gap = widest_gap(g.beam_azimuth_rad, sonar.receive_azimuth.width_rad()).widths;
  if (gap > told_gap_widths)
    fmt::print("  beams up to {:.2f} widths apart: gaps between them are heard at full gain\n", gap);
  if (!sonar.unverified.empty()) fmt::print("  unverified: {}\n", fmt::join(sonar.unverified, ", "));
  fmt::print("valid\n");
}

}  // namespace

void add_sonar(CLI::App& app) {
  auto* command = app.add_subcommand("sonar", "List, check and draw sonars");
  command->require_subcommand(1);
  command->footer(
      "Example:\n  ensonify sonar list\n  ensonify sonar check my_sonar.yaml\n"
      "  ensonify sonar show oculus_m750d_hf --out out/m750d");
  auto* all = command->add_subcommand("list", "Names and titles of the bundled sonars");
  all->footer("Example:\n  ensonify sonar list");
  auto markdown = std::make_shared<bool>(false);
  all->add_flag("--markdown", *markdown, "As a table with the main figures");
  all->callback([markdown] { *markdown ? list_markdown() : list(); });
  auto* sub = command->add_subcommand("check", "Load a sonar and say what it is, or what is wrong with it");
  auto sonar = std::make_shared<std::string>();
  sub->add_option("SONAR", *sonar, "Sonar YAML or bundled name")->required();
  sub->footer("Example:\n  ensonify sonar check oculus_m1200d_hf");
  sub->callback([sonar] { check(*sonar); });
  add_sonar_show(*command);
}

}  // namespace ensonify::cli
