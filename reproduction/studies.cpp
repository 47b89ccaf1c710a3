#include "ensonify/reproduction/studies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ensonify/config/library.hpp"
#include "ensonify/evaluation/report_records.hpp"
#include "ensonify/output/sha256.hpp"
#include "ensonify/reproduction/kept.hpp"

namespace ensonify {
namespace {

std::string hash_of(const std::string& bundled_model) {
  return sha256_of_file(resolve_name("filters/models", bundled_model, ".onnx"));
}

std::string identity_of(const Contender& contender) {
  return contender.kind == Contender::Kind::learned ? hash_of(contender.preset) : "";
}

bool by_all_models(const Contender& contender) {
  constexpr std::array chosen{"raw", "wavelet", "learned", "truth_mask"};
  return std::ranges::find(chosen, contender.label) != chosen.end();
}

bool has_frames(const Dataset& dataset, const std::string& split) {
  const auto found = std::ranges::find(dataset.splits, split, &DatasetSplit::name);
  return found != dataset.splits.end() && found->frames > 0;
}

}  // namespace

std::optional<Missing> lack_of_splits(const Dataset& dataset) {
  for (const char* split : {"val", "test"}) {
    if (has_frames(dataset, split)) continue;
    return Missing{"filters", fmt::format("the dataset {} has no frames in a split '{}': thresholds are chosen on val, "
                                          "scores taken on test",
                                          dataset.name, split)};
  }
  return {};
}

std::vector<Missing> lacks_of_truth(const Dataset& dataset) {
  if (!has_frames(dataset, "test")) return {{"maps", fmt::format("the dataset {} has no split 'test'", dataset.name)}};
  const auto judged = places_with_truth(dataset);
  std::vector<Missing> lacks;
  for (const std::string& place : places_with_frames(dataset, "test")) {
    if (std::ranges::find(judged, place) != judged.end()) continue;
    lacks.push_back({"maps of " + place, fmt::format("grids/{}.npz is missing or has no observable cell", place)});
  }
  if (judged.empty()) lacks.push_back({"maps", fmt::format("no place of the dataset {} has truth", dataset.name)});
  return lacks;
}

FilterReport judge(const Desk& desk, const std::string& name, const Dataset& dataset,
                   const std::vector<FilterCandidate>& candidates, const std::vector<FewPairsModel>& few_pairs) {
  Sha256 models;
  for (const std::string& model : bundled_models()) models.add(hash_of(model));
  for (const FewPairsModel& model : few_pairs) models.add(model.sha256);
  std::string names;
  for (const FilterCandidate& candidate : candidates)
    names += fmt::format(" {} {} {},", candidate.name, candidate.preset, fingerprint(candidate.chain));
  const std::filesystem::path file = desk.kept / (name + ".json");
  const FindingKey key = fmt::format("filters 1; {}; models {};{}", dataset.root_hash, models.hex(), names);
  const std::string record = kept_or(file, key, [&] {
    return record_of(evaluate_filters(dataset, candidates, {}, [&](const std::string& stage, int done, int total) {
      desk.on_progress(fmt::format("{}, {}", name, stage), done, total);
    }));
  });
  return filter_report_of(record, file);
}

MapFindings map_as_the_paper(const Desk& desk, const Dataset& dataset, const std::vector<Contender>& contenders) {
  std::vector<MapTask> tasks;
  for (const Contender& contender : contenders) {
    tasks.push_back({map_filter_of(contender, true), {"points"}, {MapPoses::truth}, identity_of(contender)});
  }
  return study_maps(dataset, places_with_truth(dataset), tasks, desk.kept / "maps_as_the_paper", desk.on_progress);
}

MapFindings map_contenders(const Desk& desk, const Dataset& dataset, const std::vector<Contender>& contenders) {
  std::vector<MapTask> tasks;
  for (const Contender& contender : contenders) {
    MapTask task{
        map_filter_of(contender, false), {"points"}, {MapPoses::truth, MapPoses::drifted}, identity_of(contender)};
    if (by_all_models(contender)) task.models = {"points", "arc", "arc_shadow", "carve"};
    tasks.push_back(std::move(task));
  }
  return study_maps(dataset, places_with_truth(dataset), tasks, desk.kept / "maps", desk.on_progress);
}

std::vector<FilterCandidate> tank_candidates(const std::vector<Contender>& contenders,
                                             const std::vector<FewPairsModel>& models) {
  std::vector<FilterCandidate> candidates{{"raw", "", {"raw", {}}}};
  for (const Contender& contender : contenders) {
    if (contender.kind != Contender::Kind::classical) continue;
    candidates.push_back({contender.method, contender.preset, chain_of(contender)});
  }
  for (const FewPairsModel& model : models) candidates.push_back({model.label, model.name, probability_of(model)});
  return candidates;
}

MapFindings map_tank(const Desk& desk, const Dataset& tank, const std::vector<Contender>& contenders,
                     const std::vector<FewPairsModel>& models) {
  const std::vector<std::string> inverse_models{"points", "carve"};
  std::vector<MapTask> tasks;
  for (const Contender& contender : contenders) {
    if (contender.kind == Contender::Kind::learned || !by_all_models(contender)) continue;
    tasks.push_back({map_filter_of(contender, false), inverse_models, {MapPoses::truth}, ""});
  }
  for (const FewPairsModel& model : models) {
    const MapFilter filter{model.label, MapSource::raw, chain_for_maps(mask_of(model), false)};
    tasks.push_back({filter, inverse_models, {MapPoses::truth}, model.sha256});
  }
  return study_maps(tank, places_with_truth(tank), tasks, desk.kept / "tank_maps", desk.on_progress);
}

}  // namespace ensonify
