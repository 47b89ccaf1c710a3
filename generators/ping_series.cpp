#include "ensonify/generators/ping_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/even_tiles.hpp"
#include "ensonify/output/grey_file.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

constexpr double still_m = 1e-3;
constexpr double still_deg = 0.01;
constexpr std::size_t most_pixels = std::size_t{1} << 24;

GreyImage of_bearable_size(GreyImage image, const fs::path& name) {
  if (image.grey.size() <= most_pixels) return image;
  throw DataError(fmt::format("{}: {} x {} pixels; an image of a ping has at most {}", name.string(), image.grey.rows(),
                              image.grey.columns(), most_pixels));
}

bool is_png(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
  return extension == ".png";
}

PingSeries open_folder(const fs::path& folder) {
  PingSeries pings;
  pings.folder = folder;
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  if (error) throw DataError(fmt::format("{}: can not be read as a folder: {}", folder.string(), error.message()));
  for (const auto& entry : entries) {
    if (entry.is_regular_file(error) && is_png(entry.path())) pings.files.push_back(entry.path().filename().string());
  }
  if (pings.files.empty()) {
    throw DataError(fmt::format(
        "{}: neither a dataset nor a folder of images: no dataset.json and no *.png in it (folders below are not "
        "searched)",
        folder.string()));
  }
  std::sort(pings.files.begin(), pings.files.end());
  const fs::path whole = fs::absolute(folder, error).lexically_normal();
  pings.name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  return pings;
}

PingSeries open_split(const fs::path& folder, const std::string& split) {
  PingSeries pings;
  pings.folder = folder;
  pings.dataset = open_dataset(folder);
  pings.name = pings.dataset->name;
  const auto& splits = pings.dataset->splits;
  const auto found = std::find_if(splits.begin(), splits.end(), [&](const auto& s) { return s.name == split; });
  if (found == splits.end()) {
    std::string names;
    for (const DatasetSplit& s : splits) names += (names.empty() ? "" : ", ") + s.name;
    throw ConfigError(
        fmt::format("{}: the dataset has no split {}; --split names one of {}", folder.string(), split, names));
  }
  pings.split = static_cast<int>(found - splits.begin());
  const MetadataIndex metadata = index_metadata(*pings.dataset, pings.split);
  for (const DatasetBlock& block : found->blocks) {
    for (FrameInfo& info : read_frames(metadata, block.first, block.frames)) {
      pings.files.push_back(fmt::format("{:06}", info.number));
      pings.places.push_back(std::move(info.place));
      pings.T_world_sonar.push_back(info.T_world_sonar);
    }
  }
  return pings;
}

}  // namespace

bool PingSeries::follow(int i) const {
  if (i + 1 >= count()) return false;
  const auto at = static_cast<std::size_t>(i);
  return places.empty() || places[at] == places[at + 1];
}

std::optional<bool> PingSeries::still(int i) const {
  if (T_world_sonar.empty()) return std::nullopt;
  const Pose &a = T_world_sonar[static_cast<std::size_t>(i)], &b = T_world_sonar[static_cast<std::size_t>(i) + 1];
  const Eigen::AngleAxisd turn(a.rotation().transpose() * b.rotation());
  return (a.translation() - b.translation()).norm() <= still_m && degrees(turn.angle()) <= still_deg;
}

PingSeries open_pings(const fs::path& folder, const std::string& split) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw DataError(fmt::format("{}: no such folder", folder.string()));
  // An unfinished dataset is told as one, not as a folder without images.
  const DatasetPaths paths{folder};
  if (fs::exists(paths.manifest(), error) || fs::exists(paths.state(), error)) return open_split(folder, split);
  return open_folder(folder);
}

GreyImage read_ping(const PingSeries& pings, int i) {
  const std::string& file = pings.files.at(static_cast<std::size_t>(i));
  GreyImage image;
  fs::path name = pings.folder / file;
  if (!pings.dataset) {
    image = of_bearable_size(read_grey(name), name);
  } else if (const Dataset& dataset = *pings.dataset; dataset.format == SampleFormat::folder) {
    name = DatasetPaths{pings.folder}.image(dataset.splits[static_cast<std::size_t>(pings.split)].name, "raw", i);
    image = of_bearable_size(read_grey(name), name);
  } else {
    image = std::visit([](const auto& raw) { return to_grey(raw); }, read_pixels(dataset, pings.split, i).raw);
  }
  if (image.grey.rows() < tile_rows || image.grey.columns() < tile_columns) {
    throw DataError(fmt::format("{}: {} x {} pixels; statistics need at least {} rows (range) and {} columns (beams)",
                                name.string(), image.grey.rows(), image.grey.columns(), tile_rows, tile_columns));
  }
  return image;
}

std::vector<int> spread_pairs(int count, int most) {
  std::vector<int> chosen;
  if (most >= count) {
    chosen.resize(static_cast<std::size_t>(count));
    std::iota(chosen.begin(), chosen.end(), 0);
    return chosen;
  }
  const int pairs = std::max(1, most / 2);
  for (int p = 0; p < pairs; ++p) {
    const int first = static_cast<int>(std::int64_t{p} * count / pairs);
    chosen.push_back(first);
    if (most > 1) chosen.push_back(first + 1);
  }
  return chosen;
}

}  // namespace ensonify
