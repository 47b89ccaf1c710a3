#include "ensonify/reproduction/map_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "ensonify/core/available_memory.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/evaluation/report_records.hpp"
#include "ensonify/generators/map_box.hpp"
#include "ensonify/generators/map_parts.hpp"
#include "ensonify/output/html_text.hpp"
#include "ensonify/reproduction/contenders.hpp"
#include "ensonify/reproduction/kept.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

MapEvaluation evaluation_of(const MapTask& task, const std::vector<std::string>& places) {
  MapEvaluation what;
  what.filters = {task.filter};
  what.models = task.models;
  what.poses = task.poses;
  what.places = places;
  what.memory_bytes = static_cast<double>(available_memory_bytes());
  return what;
}

FindingKey key_of(const Dataset& dataset, const std::vector<std::string>& places, const MapTask& task) {
  return fmt::format("maps 1; {}; {}; {} {}; {}; {} kinds of poses", dataset.root_hash, fmt::join(places, " "),
                     task.filter.name, fingerprint(task.filter.chain) + " " + task.identity,
                     fmt::join(task.models, " "), task.poses.size());
}

/// The rows of a task's sheets: truth and its maps, one a place.
ContactSheet gathered(std::vector<std::pair<std::string, ContactSheet>> pictures) {
  ContactSheet sheet;
  for (auto& [place, of_place] : pictures) {
    sheet.rows.push_back(std::move(of_place.rows.at(0)));
    sheet.rows.back().label = place;
  }
  return sheet;
}

/// What one task found: kept, or made and kept.
std::pair<MapReport, ContactSheet> done(const Dataset& dataset, const std::vector<std::string>& places,
                                        const MapTask& task, const fs::path& kept, const OnProgress& on_progress) {
  const FindingKey key = key_of(dataset, places, task);
  const fs::path record = kept / (anchor_of(task.filter.name) + ".json"), folder = kept / anchor_of(task.filter.name);
  const auto text = find_kept(record, key);
  auto sheet = text ? find_kept_sheet(folder, key) : std::nullopt;
  if (text && sheet) return {map_report_of(*text, record), *std::move(sheet)};
  MapEvaluationResult made = evaluate_maps(dataset, evaluation_of(task, places), on_progress);
  sheet = gathered(std::move(made.pictures));
  keep_sheet(folder, key, *sheet);
  keep(record, key, record_of(made.report));
  return {std::move(made.report), *std::move(sheet)};
}

}  // namespace

std::vector<std::string> places_with_truth(const Dataset& dataset) {
  std::vector<std::string> places = places_with_frames(dataset, "test");
  std::erase_if(places, [&](const std::string& place) {
    const auto grid = truth_of_place(dataset, place);
    return !grid || grid->observable.empty() || observable_box(*grid).empty();
  });
  return places;
}

MapFindings study_maps(const Dataset& dataset, const std::vector<std::string>& places,
                       const std::vector<MapTask>& tasks, const fs::path& kept, const OnProgress& on_progress) {
  MapFindings found;
  for (const std::string& place : places) found.pictures.push_back({place, {place, {{place, {}}}}});
  for (const MapTask& task : tasks) {
    const auto of_task = [&](const std::string& stage, int at, int total) {
      on_progress(fmt::format("{} of {}", stage, task.filter.name), at, total);
    };
    auto [report, sheet] = done(dataset, places, task, kept, of_task);
    for (std::size_t p = 0; p < places.size(); ++p) {
      std::vector<ContactTile>& from = sheet.rows.at(p).tiles;
      std::vector<ContactTile>& into = found.pictures[p].second.rows[0].tiles;
      if (into.empty()) into.push_back(from.at(0));
      into.push_back(from.at(1));
      into.back().caption = task.filter.name + ": " + into.back().caption;
    }
    if (found.report.thresholds.empty()) {
      found.report = std::move(report);
    } else {
      std::ranges::move(report.curves, std::back_inserter(found.report.curves));
    }
  }
  return found;
}

}  // namespace ensonify
