#include "ensonify/generators/acceptance_bands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t max_bytes = std::size_t{1} << 20;

struct Known {
  const char* id;
  const char* quantity;
  double (*of_tiles)(const SpeckleFigures&);  ///< null: of neighbouring pings
};

constexpr std::array<Known, 10> known_figures{{
    {"weibull_shape", "Weibull shape k of the normalised pixel",
     [](const SpeckleFigures& f) { return f.fits.weibull_shape; }},
    {"weibull_ks", "Kolmogorov-Smirnov distance of that Weibull fit",
     [](const SpeckleFigures& f) { return f.fits.ks.weibull; }},
    {"amp_domain_moment_ratio", "<I^2>/<I>^2 with I = x^k; 2 = fully developed speckle",
     [](const SpeckleFigures& f) { return f.moment_ratio; }},
    {"acf_beam_lag1", "autocorrelation across beams, lag 1", [](const SpeckleFigures& f) { return f.beam[1]; }},
    {"acf_beam_lag2", "autocorrelation across beams, lag 2", [](const SpeckleFigures& f) { return f.beam[2]; }},
    {"acf_range_lag1", "autocorrelation along range, lag 1", [](const SpeckleFigures& f) { return f.range[1]; }},
    {"interping_corr_high_snr", "ping-to-ping correlation of the normalised speckle, brightest quarter", nullptr},
    {noise_band, "the same, darkest quarter", nullptr},
    {"zero_share", "share of pixels equal to 0", [](const SpeckleFigures& f) { return f.zero_share; }},
    {"saturated_share", "share of pixels >= 254", [](const SpeckleFigures& f) { return f.saturated_share; }},
}};

const Known* find_known(const std::string& id) {
  const auto found =
      std::find_if(known_figures.begin(), known_figures.end(), [&](const Known& known) { return id == known.id; });
  return found == known_figures.end() ? nullptr : &*found;
}

std::optional<double> bound(const json& band, const char* key) {
  if (!band.contains(key) || band.at(key).is_null()) return std::nullopt;
  return band.at(key).get<double>();
}

AcceptanceBand read_band(const json& entry) {
  AcceptanceBand band;
  band.id = entry.at("id").get<std::string>();
  if (!find_known(band.id)) {
    std::string ids;
    for (const Known& known : known_figures) ids += fmt::format("{}{}", ids.empty() ? "" : ", ", known.id);
    throw DataError(fmt::format("no figure is called '{}'; there are {}", band.id.substr(0, 60), ids));
  }
  band.quantity = entry.value("quantity", std::string());
  band.min = bound(entry, "min");
  band.max = bound(entry, "max");
  band.max_exclusive = entry.value("max_exclusive", false);
  if (band.min && band.max && *band.min > *band.max) {
    throw DataError(fmt::format("band {}: min {} is above max {}", band.id, *band.min, *band.max));
  }
  return band;
}

}  // namespace

std::vector<AcceptanceBand> read_acceptance_bands(const fs::path& folder) {
  const fs::path file = folder / "acceptance.json";
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  const json root = parse_json(read_text(file, max_bytes), file);
  std::vector<AcceptanceBand> bands;
  try {
    for (const json& entry : root.at("bands")) bands.push_back(read_band(entry));
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken bands: {}", file.string(), e.what()));
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", file.string(), e.what()));
  }
  return bands;
}

std::vector<AcceptanceBand> unbounded_bands() {
  std::vector<AcceptanceBand> bands;
  for (const Known& known : known_figures) {
    AcceptanceBand& band = bands.emplace_back();
    band.id = known.id;
    band.quantity = known.quantity;
  }
  return bands;
}

std::optional<double> band_value(const SideFigures& side, const std::string& id) {
  const Known* known = find_known(id);
  if (!known) return std::nullopt;
  if (!known->of_tiles) return id == noise_band ? side.ping_to_ping.dark : side.ping_to_ping.bright;
  if (!side.even) return std::nullopt;
  return known->of_tiles(*side.even);
}

std::optional<double> band_value(const RegionFigures& region, const std::string& id) {
  const Known* known = find_known(id);
  if (!known) return std::nullopt;
  return known->of_tiles ? known->of_tiles(region.speckle) : region.ping_to_ping;
}

std::optional<bool> inside(const AcceptanceBand& band, const SideFigures& side) {
  const std::optional<double> value = band_value(side, band.id);
  const bool moved = band.id.starts_with("interping") && !side.ping_to_ping.still.value_or(true);
  if (!value || moved || (!band.min && !band.max)) return std::nullopt;
  if (band.min && *value < *band.min) return false;
  if (!band.max) return true;
  return band.max_exclusive ? *value < *band.max : *value <= *band.max;
}

}  // namespace ensonify
