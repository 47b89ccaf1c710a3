#include "ensonify/generators/dataset_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "ensonify/core/echo.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/json_text.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"
#include "ensonify/output/tar_shard.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array kinds{"raw", "clean", "mask", "labels"};

[[noreturn]] void refuse_manifest(const std::string& rule) {
  throw DataError(fmt::format("broken manifest: {}", rule));
}

std::vector<DatasetPlace> places_of(const json& split) {
  std::vector<DatasetPlace> places;
  for (const json& place : split.at("places")) {
    const auto scene = fs::path(place.at("scene").get<std::string>()).stem().string();
    places.push_back({place.at("name"), scene, place.at("layout")});
  }
  return places;
}

/// A split's name becomes part of paths.
void check_split_name(const std::string& name) {
  if (name == "train" || name == "val" || name == "test") return;
  refuse_manifest(fmt::format("no split '{}'; there are train, val and test", name.substr(0, 40)));
}

constexpr std::size_t max_manifest_bytes = std::size_t{1} << 28;
constexpr int max_frames = 100'000'000;

int whole_number(const json& value, int low, int high) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() < static_cast<std::uint64_t>(low) ||
      value.get<std::uint64_t>() > static_cast<std::uint64_t>(high)) {
    refuse_manifest(fmt::format("{} is no whole number from {} to {}", value.dump().substr(0, 40), low, high));
  }
  return value.get<int>();
}

std::vector<DatasetSplit> splits_of(const json& manifest) {
  std::vector<DatasetSplit> splits;
  for (const json& shard : manifest.at("shards")) {
    const std::string name = shard.at("split");
    if (splits.empty() || splits.back().name != name) {
      check_split_name(name);
      splits.push_back({name, 0, places_of(manifest.at("recipe").at("splits").at(name)), {}});
    }
    DatasetSplit& split = splits.back();
    const int frames = whole_number(shard.at("frames"), 1, max_frames - split.frames);
    split.blocks.push_back({static_cast<int>(splits.size()) - 1, static_cast<int>(split.blocks.size()), split.frames,
                            frames, shard.at("sha256")});
    split.frames += frames;
  }
  const json& counts = manifest.at("counts");
  if (splits.empty() || counts.size() != splits.size()) refuse_manifest("counts and shards name other splits");
  for (const DatasetSplit& split : splits) {
    const int expected = whole_number(counts.at(split.name), 1, max_frames);
    if (split.frames != expected) {
      refuse_manifest(
          fmt::format("{}: the shards of the manifest hold {} frames, not {}", split.name, split.frames, expected));
    }
  }
  return splits;
}

void read_manifest(Dataset& dataset) {
  const json manifest = parse_json(dataset.manifest, "broken manifest");
  const json& recipe = manifest.at("recipe");
  dataset.name = recipe.at("name");
  dataset.title = recipe.at("title");
  dataset.root_hash = manifest.at("root_hash");
  const std::string format = manifest.at("format");
  if (format != "folder" && format != "webdataset") refuse_manifest("the format is neither folder nor webdataset");
  dataset.format = format == "webdataset" ? SampleFormat::webdataset : SampleFormat::folder;
  dataset.mask_threshold = whole_number(manifest.at("mask").at("threshold"), 0, 255);
  const json& sonar = manifest.at("sonar");
  dataset.raw_bits = whole_number(sonar.at("receive").at("bits"), 8, 16);
  dataset.beams = static_cast<int>(sonar.at("beam_azimuth_rad").size());
  // A recipe may draw the range window a frame, and then the number of native bins may differ.
  const json& window = recipe.at("sonar");
  const bool varies = window.contains("range_max_m") && window["range_max_m"].is_object();
  dataset.range_bins = varies ? 0 : whole_number(sonar.at("range_bins"), 1, 1 << 20);
  dataset.splits = splits_of(manifest);
}

void set_image(FramePixels& pixels, const std::string& kind, int bits, std::span<const std::uint8_t> png,
               const fs::path& name) {
  if (kind == "raw" && bits == 16) {
    pixels.raw = decode_png<std::uint16_t>(png, name);
    return;
  }
  Image2<std::uint8_t> image = decode_png<std::uint8_t>(png, name);
  if (kind == "raw")
    pixels.raw = std::move(image);
  else if (kind == "clean")
    pixels.clean = std::move(image);
  else if (kind == "mask")
    pixels.mask = std::move(image);
  else
    pixels.labels = std::move(image);
}

void read_tar_block(const Dataset& dataset, const DatasetBlock& block, const std::function<bool(int)>& wanted,
                    const std::function<void(int, const FramePixels&)>& visit, const FrameKinds& which) {
  const std::string& split = dataset.splits[static_cast<std::size_t>(block.split)].name;
  const fs::path path = DatasetPaths{dataset.folder}.tar(split, block.number_in_split);
  const int end = block.first + block.frames;
  FramePixels pixels;
  std::size_t images = 0;
  int number = block.first;
  read_tar(path, [&](const std::string& member, const std::vector<std::uint8_t>& bytes) {
    if (number >= end) throw DataError(fmt::format("{}: more frames than the manifest says", path.string()));
    const std::string stem = fmt::format("{:06}.", number);
    if (!member.starts_with(stem)) throw DataError(fmt::format("{}: unexpected member {}", path.string(), member));
    const std::string kind = member.substr(stem.size(), member.find('.', stem.size()) - stem.size());
    if (kind != "json") {
      if (std::ranges::find(kinds, kind) == kinds.end()) {
        throw DataError(fmt::format("{}: {} is not an image of a frame", path.string(), member));
      }
      if (wanted(number) && which.has(kind)) set_image(pixels, kind, dataset.raw_bits, bytes, path / member);
      ++images;
      return;
    }
    if (images != kinds.size()) throw DataError(fmt::format("{}: {} lacks images", path.string(), member));
    if (wanted(number)) visit(number, pixels);
    pixels = {};
    images = 0;
    ++number;
  });
  if (number != end) throw DataError(fmt::format("{}: frames are missing", path.string()));
}

FramePixels read_files(const Dataset& dataset, int split, int number, const FrameKinds& which) {
  FramePixels pixels;
  for (const char* kind : kinds) {
    if (!which.has(kind)) continue;
    const std::string& name = dataset.splits[static_cast<std::size_t>(split)].name;
    const fs::path file = DatasetPaths{dataset.folder}.image(name, kind, number);
    set_image(pixels, kind, dataset.raw_bits, read_file(file), file);
  }
  return pixels;
}

}  // namespace

int Dataset::frames() const {
  return std::accumulate(splits.begin(), splits.end(), 0,
                         [](int sum, const DatasetSplit& split) { return sum + split.frames; });
}

Dataset open_dataset(const fs::path& folder) {
  Dataset dataset;
  dataset.folder = folder;
  const fs::path manifest = DatasetPaths{folder}.manifest();
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw DataError(fmt::format("{}: no dataset.json: no such folder", folder.string()));
  if (!fs::is_regular_file(manifest, error)) {
    throw DataError(fmt::format(
        "{}: no dataset.json: no dataset, or an unfinished one; run generate again to finish it", folder.string()));
  }
  dataset.manifest = read_text(manifest, max_manifest_bytes);
  try {
    read_manifest(dataset);
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: broken manifest: {}", manifest.string(), e.what()));
  } catch (const DataError& e) {
    throw DataError(fmt::format("{}: {}", manifest.string(), e.what()));
  }
  return dataset;
}

void read_block(const Dataset& dataset, const DatasetBlock& block, const std::function<bool(int)>& wanted,
                const std::function<void(int, const FramePixels&)>& visit, const FrameKinds& which) {
  if (dataset.format == SampleFormat::webdataset) return read_tar_block(dataset, block, wanted, visit, which);
  for (int number = block.first; number < block.first + block.frames; ++number) {
    if (wanted(number)) visit(number, read_files(dataset, block.split, number, which));
  }
}

FramePixels read_pixels(const Dataset& dataset, int split, int number, const FrameKinds& which) {
  if (dataset.format == SampleFormat::folder) return read_files(dataset, split, number, which);
  const auto& blocks = dataset.splits.at(static_cast<std::size_t>(split)).blocks;
  const auto after = std::upper_bound(blocks.begin(), blocks.end(), number,
                                      [](int n, const DatasetBlock& block) { return n < block.first; });
  FramePixels found;
  read_tar_block(
      dataset, after[-1], [&](int n) { return n == number; }, [&](int, const FramePixels& pixels) { found = pixels; },
      which);
  return found;
}

std::vector<Channel> read_truth(const Dataset& dataset, int split, int number) {
  const fs::path file =
      DatasetPaths{dataset.folder}.image(dataset.splits.at(static_cast<std::size_t>(split)).name, "truth", number);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw DataError(fmt::format("{}: no such file; only a recipe with truth: true has it", file.string()));
  }
  return read_exr(file);
}

std::string pixel_fault(const Dataset& dataset, const FramePixels& pixels) {
  const auto size_fault = [&](const auto& image) {
    const int bins = dataset.range_bins > 0 ? dataset.range_bins : pixels.clean.rows();
    const bool right = image.columns() == dataset.beams && image.rows() == bins;
    return right ? std::string()
                 : fmt::format("{} x {} pixels, not {} x {}", image.rows(), image.columns(), bins, dataset.beams);
  };
  for (const std::string& fault : {std::visit(size_fault, pixels.raw), size_fault(pixels.clean),
                                   size_fault(pixels.mask), size_fault(pixels.labels)}) {
    if (!fault.empty()) return fault;
  }
  const auto clean = pixels.clean.pixels();
  const auto mask = pixels.mask.pixels();
  const auto labels = pixels.labels.pixels();
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (mask[i] != (clean[i] >= dataset.mask_threshold ? 255 : 0)) {
      return fmt::format("mask is not clean >= {}", dataset.mask_threshold);
    }
    constexpr auto last_label = static_cast<std::uint8_t>(PixelLabel::outside);
    if (labels[i] > last_label) return fmt::format("a label is {}, above {}", labels[i], last_label);
  }
  return {};
}

}  // namespace ensonify
