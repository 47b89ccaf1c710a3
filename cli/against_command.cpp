#include "ensonify/cli/against_command.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "ensonify/cli/progress.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/against_json.hpp"
#include "ensonify/generators/against_plots.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify::cli {
namespace {

/// "[name=]row0 row1 column0 column1", blanks or commas between.
NamedRegion parse_region(const std::string& text) {
  const auto refuse = [&](const std::string& rule) {
    return ConfigError(fmt::format(
        "--region \"{}\": {}; it is \"[name=]row0 row1 column0 column1\", like \"far=560 700 20 240\"", text, rule));
  };
  const std::size_t equals = text.find('=');
  NamedRegion named;
  std::array<int, 4> numbers{};
  std::size_t count = 0;
  const std::string list = equals == std::string::npos ? text : text.substr(equals + 1);
  const char *at = list.data(), *end = at + list.size();
  while (true) {
    while (at < end && (*at == ' ' || *at == ',')) ++at;
    if (at == end) break;
    int number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (after < end && *after != ' ' && *after != ',')) throw refuse("not whole numbers");
    if (count == numbers.size()) throw refuse("more than four numbers");
    numbers[count++] = number;
    at = after;
  }
  if (count < numbers.size()) throw refuse("fewer than four numbers");
  named.region = {numbers[0], numbers[1], numbers[2], numbers[3]};
  if (named.region.row0 < 0 || named.region.column0 < 0 || named.region.rows() <= 0 || named.region.columns() <= 0) {
    throw refuse("the second number of each pair must be above the first, and none below 0");
  }
  named.name = equals == std::string::npos ? fmt::format("{}-{}x{}-{}", numbers[0], numbers[1], numbers[2], numbers[3])
                                           : text.substr(0, equals);
  if (named.name.empty()) throw refuse("the name is empty");
  return named;
}

std::vector<NamedRegion> parse_regions(const std::vector<std::string>& texts) {
  std::vector<NamedRegion> regions;
  for (const std::string& text : texts) {
    regions.push_back(parse_region(text));
    for (std::size_t i = 0; i + 1 < regions.size(); ++i) {
      if (regions[i].name == regions.back().name) {
        throw ConfigError(fmt::format("--region: two are called {}; give each a name of its own", regions[i].name));
      }
    }
  }
  return regions;
}

std::string number(const std::optional<double>& value) { return value ? fmt::format("{:.3f}", *value) : "-"; }

std::string verdict(const std::optional<bool>& inside) {
  return inside ? std::string(*inside ? "inside" : "OUTSIDE") : std::string();
}

std::string bounds(const AcceptanceBand& band) {
  if (!band.min && !band.max) return {};
  if (!band.min) return fmt::format("{} {}", band.max_exclusive ? "<" : "<=", *band.max);
  return band.max ? fmt::format("{} to {}", *band.min, *band.max) : fmt::format(">= {}", *band.min);
}

void print_table(const SideFigures& simulated, const SideFigures& real, std::vector<AcceptanceBand> bands) {
  const auto line = [](const std::string& name, const std::string& a, const std::string& b,
                       const std::string& band = {}, const std::string& inside_a = {},
                       const std::string& inside_b = {}) {
    std::string text = fmt::format("  {:<26} {:>12} {:<8} {:>12} {:<8} {}", name, a, inside_a, b, inside_b, band);
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", text);
  };
  const auto both = [&](const char* name, const auto& of) { line(name, of(simulated), of(real)); };
  fmt::print("{}{} (simulated) against {} (real)\n", simulated.name,
             simulated.dataset ? fmt::format(", split {}", simulated.split) : "", real.name);
  line("", "simulated", "real", bands.empty() ? "" : "band");
  both("images read", [](const SideFigures& s) { return fmt::format("{} of {}", s.read.size(), s.images); });
  both("whole images: mean level", [](const SideFigures& s) { return number(s.levels.mean()); });
  both("  median level", [](const SideFigures& s) { return number(s.levels.percentile(50)); });
  both("  zero share", [](const SideFigures& s) {
    return fmt::format("{:.4f}", static_cast<double>(s.levels.zeros) / static_cast<double>(s.levels.pixels));
  });
  both("  saturated share", [](const SideFigures& s) {
    return fmt::format("{:.4f}", static_cast<double>(s.levels.saturated) / static_cast<double>(s.levels.pixels));
  });
  both("even tiles", [](const SideFigures& s) { return fmt::format("{}", s.tiles.size()); });
  both("pairs of pings", [](const SideFigures& s) {
    const bool moved = !s.ping_to_ping.still.value_or(true);
    return fmt::format("{}{}", s.ping_to_ping.pairs, moved ? " moving" : "");
  });
  if (bands.empty()) bands = unbounded_bands();
  for (const AcceptanceBand& band : bands) {
    line(band.id, number(band_value(simulated, band.id)), number(band_value(real, band.id)), bounds(band),
         verdict(inside(band, simulated)), verdict(inside(band, real)));
  }
  for (std::size_t r = 0; r < simulated.regions.size(); ++r) {
    fmt::print("  region {}\n", simulated.regions[r].named.name);
    for (const AcceptanceBand& band : bands) {
      if (band.id == noise_band) continue;  // a region is one area
      line("  " + band.id, number(band_value(simulated.regions[r], band.id)),
           number(band_value(real.regions[r], band.id)));
    }
  }
  for (const SideFigures* side : {&simulated, &real}) {
    if (!side->tiles.empty()) continue;
    fmt::print(
        "  no even tile in {}: none of {} x {} pixels has a mean level of {} or more and varies by {} or less;\n"
        "  a lower --least-level or a --region may show what there is\n",
        side->name, tile_rows, tile_columns, side->least_level, most_even_variation);
  }
}

}  // namespace

void run_against(const AgainstArguments& a) {
  AgainstOptions options;
  options.regions = parse_regions(a.regions);
  options.least_level = a.least_level;
  if (a.max_images > 0) options.max_images = a.max_images;
  const PingSeries simulated_pings = open_pings(a.folder, a.split), real_pings = open_pings(a.real, a.split);
  if (a.out.empty() && !a.json && !simulated_pings.dataset) {
    throw ConfigError(fmt::format("{}: no dataset, so --out must say where against.json goes", a.folder));
  }
  const std::vector<AcceptanceBand> bands = read_acceptance_bands(a.real);

  ProgressLine progress(parse_progress_style(a.progress));
  const auto shown = [&](const char* stage) {
    return [&, stage](int done, int total) { progress.show(stage, done, done, total); };
  };
  const SideFigures simulated = describe_side(simulated_pings, options, shown("simulated"));
  const SideFigures real = describe_side(real_pings, options, shown("real"));
  const std::string json = against_json(simulated, real, bands);
  if (a.json) {
    fmt::print("{}", json);
    return;
  }
  const auto out = a.out.empty() ? std::filesystem::path(a.folder) / "stats" : std::filesystem::path(a.out);
  write_file(out / "against.json", json);
  write_file(out / "against.png", draw_plots(against_plots(simulated, real)));
  write_file(out / "against_pings.png",
             encode_png(draw_contact_sheet(against_pictures(simulated_pings, simulated, real_pings, real))));
  print_table(simulated, real, bands);
  fmt::print("against.json against.png against_pings.png in {}\n", out.string());
}

}  // namespace ensonify::cli
