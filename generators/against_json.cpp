#include "ensonify/generators/against_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ensonify {
namespace {

using json = nlohmann::ordered_json;

template <typename Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

json to_json(const SpeckleFigures& f) {
  const AmplitudeFits& fits = f.fits;
  return {{"mean_level", f.mean_level},
          {"zero_share", f.zero_share},
          {"saturated_share", f.saturated_share},
          {"contrast", f.contrast},
          {"weibull", {{"shape", fits.weibull_shape}, {"scale", fits.weibull_scale}}},
          {"gamma", {{"shape", fits.gamma_shape}, {"scale", fits.gamma_scale}}},
          {"lognormal", {{"sigma", fits.lognormal_sigma}, {"scale", fits.lognormal_scale}}},
          {"nakagami", {{"shape", fits.nakagami_shape}, {"scale", fits.nakagami_scale}}},
          {"k", {{"shape", fits.k_shape}}},
          {"ks",
           {{"weibull", fits.ks.weibull},
            {"gamma", fits.ks.gamma},
            {"lognormal", fits.ks.lognormal},
            {"nakagami", fits.ks.nakagami},
            {"k", fits.ks.k},
            {"rayleigh", fits.ks.rayleigh},
            {"exponential", fits.ks.exponential}}},
          {"amp_domain_moment_ratio", f.moment_ratio},
          {"acf_range", f.range},
          {"acf_beam", f.beam}};
}

json to_json(const LevelSums& sums) {
  const auto pixels = static_cast<double>(sums.pixels);
  json entry{{"pixels", sums.pixels},
             {"mean", sums.mean()},
             {"std", sums.standard_deviation()},
             {"zero_share", static_cast<double>(sums.zeros) / pixels},
             {"saturated_share", static_cast<double>(sums.saturated) / pixels}};
  for (const double p : level_percents) entry["percentiles"][fmt::format("{}", p)] = sums.percentile(p);
  const auto profile = [](const auto& part_sums, const auto& part_pixels) {
    json means = json::array();
    for (std::size_t i = 0; i < part_sums.size(); ++i) {
      means.push_back(part_sums[i] / static_cast<double>(part_pixels[i]));
    }
    return means;
  };
  entry["range_profile"] = profile(sums.range_sum, sums.range_pixels);
  entry["beam_profile"] = profile(sums.beam_sum, sums.beam_pixels);
  entry["histogram"] = sums.histogram;
  return entry;
}

json to_json(const Region& r) { return {{"rows", {r.row0, r.row1}}, {"columns", {r.column0, r.column1}}}; }

json tiles_json(const SideFigures& side, const std::map<int, std::string>& file_of) {
  json entry{{"rows", tile_rows},
             {"columns", tile_columns},
             {"least_mean_level", side.least_level},
             {"most_variation", most_even_variation},
             {"most_an_image", most_even_tiles},
             {"count", side.tiles.size()},
             {"median", side.even ? to_json(*side.even) : json(nullptr)},
             {"each", json::array()}};
  for (const TileFigures& t : side.tiles) {
    entry["each"].push_back({{"image", file_of.at(t.image)},
                             {"row", t.tile.region.row0},
                             {"column", t.tile.region.column0},
                             {"mean_level", t.tile.mean_level},
                             {"variation", t.tile.variation},
                             {"weibull_shape", t.speckle.fits.weibull_shape},
                             {"weibull_ks", t.speckle.fits.ks.weibull},
                             {"amp_domain_moment_ratio", t.speckle.moment_ratio}});
  }
  return entry;
}

json to_json(const SideFigures& side) {
  std::map<int, std::string> file_of;
  for (std::size_t i = 0; i < side.read.size(); ++i) file_of[side.read[i]] = side.files[i];
  const PingToPing& pings = side.ping_to_ping;
  json entry{{"name", side.name},
             {"split", side.dataset ? json(side.split) : json(nullptr)},
             {"images", side.images},
             {"images_read", side.read.size()},
             {"first_image", {{"rows", side.rows}, {"columns", side.columns}}},
             {"levels", to_json(side.levels)},
             {"even_tiles", tiles_json(side, file_of)},
             {"ping_to_ping",
              {{"pairs", pings.pairs},
               {"still", or_null(pings.still)},
               {"tiles", pings.tiles.size()},
               {"brightest_quarter", or_null(pings.bright)},
               {"darkest_quarter", or_null(pings.dark)}}},
             {"regions", json::object()}};
  for (const RegionFigures& region : side.regions) {
    json& at = entry["regions"][region.named.name];
    at = to_json(region.named.region);
    at.update(to_json(region.speckle));
    at["ping_to_ping"] = or_null(region.ping_to_ping);
  }
  return entry;
}

}  // namespace

std::string against_json(const SideFigures& simulated, const SideFigures& real,
                         const std::vector<AcceptanceBand>& bands) {
  json root{{"schema", "ensonify-against"},
            {"schema_version", 1},
            {"tool", {{"name", "ensonify"}, {"version", ENSONIFY_VERSION}}},
            {"bands", json::array()}};
  for (const AcceptanceBand& band : bands) {
    root["bands"].push_back({{"id", band.id},
                             {"quantity", band.quantity},
                             {"min", or_null(band.min)},
                             {"max", or_null(band.max)},
                             {"simulated", or_null(band_value(simulated, band.id))},
                             {"simulated_inside", or_null(inside(band, simulated))},
                             {"real", or_null(band_value(real, band.id))},
                             {"real_inside", or_null(inside(band, real))}});
  }
  root["simulated"] = to_json(simulated);
  root["real"] = to_json(real);
  return root.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace ensonify
