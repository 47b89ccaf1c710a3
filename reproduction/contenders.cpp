#include "ensonify/reproduction/contenders.hpp"

#include <algorithm>
#include <array>

#include "ensonify/config/library.hpp"
#include "ensonify/filters/filter_grid.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/output/sha256.hpp"

namespace ensonify {
namespace {

constexpr std::array in_short{"raw", "lee_enhanced", "frost", "anisodiff", "wavelet", "nlm", "unet", "unet_clean"};

FilterStep learned_step(const std::string& method) {
  FilterStep step = make_filter(method);
  set_parameter(step, "model", "paper");
  return step;
}

}  // namespace

std::vector<Contender> contenders() {
  using enum Contender::Kind;
  std::vector<Contender> all{{"raw", raw, "raw", ""},
                             {"lee_enhanced", classical, "lee_enhanced", "paper", &FilterScores::psnr_db, 8.75},
                             {"frost", classical, "frost", "paper", &FilterScores::psnr_db, 22.54},
                             {"anisodiff", classical, "anisodiff", "paper", &FilterScores::psnr_db, 0.03},
                             {"wavelet", classical, "wavelet", "paper", &FilterScores::psnr_db, 0.04}};
  if (has_model("paper")) {
    all.push_back({"learned", learned, "unet", "paper", &FilterScores::masked_psnr_db, 0.56});
    all.push_back({"learned_clean", learned, "unet_clean", "paper"});
  }
  all.push_back({"truth_mask", truth, "truth_mask", ""});
  return all;
}

const FilterScores* row_of(const FilterReport& report, const Contender& contender, const std::string& scene) {
  const auto found = std::ranges::find_if(report.rows, [&](const FilterScores& row) {
    return row.filter == contender.method && row.preset == contender.preset && row.scene == scene;
  });
  return found == report.rows.end() ? nullptr : &*found;
}

FilterChain chain_of(const Contender& contender) {
  switch (contender.kind) {
    case Contender::Kind::classical:
      return {contender.label, {make_filter(contender.method)}};
    case Contender::Kind::learned:
      return {contender.label, {learned_step(contender.method)}};
    default:
      return {contender.label, {}};
  }
}

MapFilter map_filter_of(const Contender& contender, bool post_process) {
  const MapSource source = contender.kind == Contender::Kind::truth ? MapSource::truth_mask : MapSource::raw;
  return {contender.label, source, chain_for_maps(chain_of(contender), post_process)};
}

std::string fingerprint(const FilterChain& chain) {
  Sha256 all;
  for (const FilterStep& step : chain.steps) all.add(preset_yaml("", "", {step}));
  return all.hex().substr(0, 16);
}

std::vector<FilterCandidate> candidates(bool all, const std::vector<std::string>& models) {
  std::vector<FilterCandidate> chosen = all_candidates(load_filter_preset("tuned"));
  std::erase_if(chosen, [&](const FilterCandidate& candidate) {
    const bool learned = candidate.name.starts_with("unet") || candidate.name == "pix2pix";
    if (learned) return std::ranges::find(models, candidate.preset) == models.end();
    return !all && std::ranges::find(in_short, candidate.name) == in_short.end();
  });
  return chosen;
}

std::vector<std::string> bundled_models() { return library_names("filters/models", ".onnx"); }

bool has_model(const std::string& name) {
  const auto models = bundled_models();
  return std::ranges::find(models, name) != models.end();
}

}  // namespace ensonify
