#include "ensonify/generators/map_pings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/json_text.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

int split_named(const Dataset& dataset, const std::string& name) {
  const auto found = std::ranges::find(dataset.splits, name, &DatasetSplit::name);
  if (found != dataset.splits.end()) return static_cast<int>(found - dataset.splits.begin());
  std::vector<std::string> names;
  for (const DatasetSplit& split : dataset.splits) names.push_back(split.name);
  throw ConfigError(
      fmt::format("{}: has no split '{}'; there are {}", dataset.folder.string(), name, fmt::join(names, ", ")));
}

/// Calls visit(frame) for every line of a split's metadata; some lines are in memory at a time.
template <typename Visit>
void for_each_frame(const Dataset& dataset, int split, const Visit& visit) {
  constexpr int at_once = 1024;
  const MetadataIndex index = index_metadata(dataset, split);
  const int frames = dataset.splits[static_cast<std::size_t>(split)].frames;
  for (int first = 0; first < frames; first += at_once) {
    for (const FrameInfo& info : read_frames(index, first, std::min(at_once, frames - first))) visit(info);
  }
}

/// Beams and field of view as the manifest has them resolved: the instrument's file may be gone or changed since.
SonarGeometry geometry_of_manifest(const Dataset& dataset) {
  SonarGeometry geometry;
  const fs::path file = DatasetPaths{dataset.folder}.manifest();
  try {
    const nlohmann::json sonar = parse_json(dataset.manifest, file).at("sonar");
    geometry.beam_azimuth_rad = sonar.at("beam_azimuth_rad").get<std::vector<double>>();
    geometry.elevation_fov_rad = sonar.at("elevation_fov_rad").get<double>();
  } catch (const nlohmann::json::exception& e) {
    throw DataError(fmt::format("{}: the sonar's beams can not be read: {}", file.string(), e.what()));
  }
  return geometry;
}

std::string place_named(const Dataset& dataset, const std::string& split, const std::string& name) {
  const std::vector<std::string> places = places_with_frames(dataset, split);
  if (name.empty() && places.size() == 1) return places.front();
  if (std::ranges::find(places, name) != places.end()) return name;
  throw ConfigError(
      fmt::format("{}: {} in split {}: {}; choose one with --scene", dataset.folder.string(),
                  name.empty() ? fmt::format("{} places", places.size()) : fmt::format("no place '{}'", name), split,
                  fmt::join(places, ", ")));
}

Image2<float> elevations_of(const Dataset& dataset, int split, int number) {
  for (auto& [name, image] : read_truth(dataset, split, number)) {
    if (name == "elevation.strongest") return std::move(image);
  }
  throw DataError(
      fmt::format("{}: truth of frame {} has no channel elevation.strongest", dataset.folder.string(), number));
}

}  // namespace

std::vector<std::string> places_with_frames(const Dataset& dataset, const std::string& split) {
  std::vector<std::string> places;
  for_each_frame(dataset, split_named(dataset, split), [&](const FrameInfo& info) {
    if (std::ranges::find(places, info.place) == places.end()) places.push_back(info.place);
  });
  return places;
}

PlacePings pings_of_place(const Dataset& dataset, const std::string& split, const std::string& place, int max_frames) {
  PlacePings pings;
  pings.place = place_named(dataset, split, place);
  pings.split = split_named(dataset, split);
  pings.geometry = geometry_of_manifest(dataset);
  std::vector<MapFrame> all;
  for_each_frame(dataset, pings.split, [&](const FrameInfo& info) {
    if (info.place != pings.place) return;
    pings.ordered = pings.ordered && info.time_s.has_value();
    all.push_back({info.number, info.range_min_m, info.range_max_m, info.T_world_sonar, info.T_world_sonar_est});
  });
  const std::size_t n = all.size();
  const std::size_t count = max_frames == 0 ? n : std::min(n, static_cast<std::size_t>(max_frames));
  for (std::size_t i = 0; i < count; ++i) pings.frames.push_back(all[(2 * i + 1) * n / (2 * count)]);
  return pings;
}

SonarGeometry geometry_of(const PlacePings& pings, std::size_t i, int range_bins) {
  SonarGeometry geometry = pings.geometry;
  geometry.range_min_m = pings.frames.at(i).range_min_m;
  geometry.range_max_m = pings.frames.at(i).range_max_m;
  geometry.range_bins = range_bins;
  return geometry;
}

bool has_elevations(const Dataset& dataset, const PlacePings& pings) {
  const std::string& split = dataset.splits.at(static_cast<std::size_t>(pings.split)).name;
  std::error_code error;
  return !pings.frames.empty() &&
         fs::is_regular_file(DatasetPaths{dataset.folder}.image(split, "truth", pings.frames.front().number), error);
}

std::vector<PosedImage> read_pings(const Dataset& dataset, const PlacePings& pings, const MapFilter& filter,
                                   MapPoses poses, bool elevations, const std::function<void()>& one_done) {
  SplitFrames wanted{pings.split, {}, {}};
  wanted.scene_of.resize(static_cast<std::size_t>(dataset.splits.at(static_cast<std::size_t>(pings.split)).frames));
  for (const MapFrame& frame : pings.frames) wanted.numbers.push_back(frame.number);
  std::vector<PosedImage> images(pings.frames.size());
  std::mutex mutex;
  visit_frames(dataset, wanted, [&](int at, const JudgedFrame& frame) {
    const auto i = static_cast<std::size_t>(at);
    Image2<std::uint8_t> grey = image_for_map(filter, frame);
    images[i].geometry = geometry_of(pings, i, grey.rows());
    images[i].grey = std::move(grey);
    images[i].T_world_sonar = pings.frames[i].pose(poses);
    if (elevations) images[i].elevation_rad = elevations_of(dataset, pings.split, frame.number);
    const std::scoped_lock lock(mutex);
    one_done();
  });
  return images;
}

double bytes_of_pings(const Dataset& dataset, const PlacePings& pings, bool elevations) {
  constexpr int most_bins = 4096;  // where the recipe draws the window
  const double pixels = 1.0 * dataset.beams * (dataset.range_bins > 0 ? dataset.range_bins : most_bins);
  return static_cast<double>(pings.frames.size()) * pixels * (elevations ? 5 : 1);
}

}  // namespace ensonify
