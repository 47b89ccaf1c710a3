#include "ensonify/generators/dataset_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr int lines_at_once = 256;
constexpr int bins_of_varied_windows = 256;

struct Windows {
  double min_m = std::numeric_limits<double>::infinity(), max_m = 0;
  bool vary = false;

  void add(const FrameInfo& frame) {
    const bool first = max_m == 0;
    vary = vary || (!first && (frame.range_min_m != min_m || frame.range_max_m != max_m));
    min_m = std::min(min_m, frame.range_min_m);
    max_m = std::max(max_m, frame.range_max_m);
  }
};

void add_frame(const FrameInfo& frame, Vec3& before, PlaceFrames& at) {
  at.numbers.push_back(frame.number);
  const Vec3 p = frame.T_world_sonar.translation();
  const auto [roll, pitch, yaw] = roll_pitch_yaw(frame.T_world_sonar);
  at.poses["depth_m"].push_back(-p.z());
  at.poses["roll_deg"].push_back(degrees(roll));
  at.poses["pitch_deg"].push_back(degrees(pitch));
  at.poses["yaw_deg"].push_back(degrees(yaw));
  for (const auto& [key, value] : frame.sampled) at.sampled[key].push_back(value);
  if (frame.time_s) {
    if (at.way) at.way->length_m += (p - before).norm();
    if (!at.way) at.way = {0.0, 0.0, 0.0};
    at.way->duration_s = *frame.time_s;
    at.way->drift_m = (frame.T_world_sonar_est.translation() - p).norm();
  }
  before = p;
}

}  // namespace

DatasetSurvey survey_metadata(const Dataset& dataset, const std::vector<MetadataIndex>& metadata) {
  DatasetSurvey survey;
  survey.place_of.resize(dataset.splits.size());
  Windows windows;
  for (std::size_t s = 0; s < dataset.splits.size(); ++s) {
    const DatasetSplit& split = dataset.splits[s];
    std::map<std::string, int> index;
    for (const DatasetPlace& place : split.places) {
      index[place.name] = static_cast<int>(survey.places.size());
      survey.places.push_back({static_cast<int>(s), place, {}, {}, {}, {}});
    }
    std::vector<Vec3> before(survey.places.size(), Vec3::Zero());
    for (int first = 0; first < split.frames; first += lines_at_once) {
      const int count = std::min(lines_at_once, split.frames - first);
      for (const FrameInfo& frame : read_frames(metadata[s], first, count)) {
        const auto found = index.find(frame.place);
        if (found == index.end()) {
          throw DataError(fmt::format("{}, line {}: place {} is not one of the split's in the manifest",
                                      metadata[s].file.string(), frame.number + 1, frame.place));
        }
        const auto at = static_cast<std::size_t>(found->second);
        add_frame(frame, before[at], survey.places[at]);
        survey.place_of[s].push_back(found->second);
        windows.add(frame);
      }
    }
  }
  const bool rows = !windows.vary && dataset.range_bins > 0;
  survey.bins = {windows.min_m, windows.max_m, rows ? dataset.range_bins : bins_of_varied_windows};
  return survey;
}

std::vector<std::vector<bool>> spread_frames(const DatasetSurvey& survey, int most) {
  std::size_t total = 0, seen = 0;
  std::vector<std::vector<bool>> taken;
  for (const auto& split : survey.place_of) {
    taken.emplace_back(split.size(), most <= 0);
    total += split.size();
  }
  for (const PlaceFrames& place : survey.places) seen += place.numbers.empty() ? 0 : 1;
  if (most <= 0) return taken;
  const auto limit = static_cast<std::size_t>(most);
  if (limit < seen) throw ConfigError(fmt::format("--max-frames {}: must be at least the {} places", most, seen));
  if (limit >= total) return spread_frames(survey, 0);
  for (const PlaceFrames& place : survey.places) {
    const std::size_t n = place.numbers.size();
    if (n == 0) continue;
    // One each, and of the rest the place's share, rounded down: never more than `most` together.
    const std::size_t quota = 1 + (limit - seen) * (n - 1) / std::max<std::size_t>(1, total - seen);
    for (std::size_t i = 0; i < quota; ++i) {
      const int number = place.numbers[(2 * i + 1) * n / (2 * quota)];
      taken[static_cast<std::size_t>(place.split)][static_cast<std::size_t>(number)] = true;
    }
  }
  return taken;
}

}  // namespace ensonify
