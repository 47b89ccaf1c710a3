#include "ensonify/generators/image_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

constexpr int tile_rows = 128;
constexpr int most_sheet_rows = 60;

/// Raw as 8 bits.
Image2<std::uint8_t> grey(const FramePixels& pixels) {
  if (const auto* raw = std::get_if<Image2<std::uint8_t>>(&pixels.raw)) return *raw;
  const auto& deep = std::get<Image2<std::uint16_t>>(pixels.raw);
  Image2<std::uint8_t> image(deep.rows(), deep.columns());
  std::transform(deep.pixels().begin(), deep.pixels().end(), image.pixels().begin(),
                 [](std::uint16_t v) { return static_cast<std::uint8_t>(v >> 8); });
  return image;
}

ContactTile tile_of(const FramePixels& pixels, int number) {
  const int columns = std::clamp(tile_rows * pixels.mask.columns() / std::max(1, pixels.mask.rows()), 16, 192);
  return {fmt::format("{:06}", number),
          {resized(grey(pixels), tile_rows, columns), resized(pixels.mask, tile_rows, columns)}};
}

/// The frames that a place shows on its split's sheet.
void want_tiles(const DatasetSurvey& survey, const std::vector<std::vector<bool>>& taken, int columns,
                ImageFigures& figures) {
  std::vector<int> rows(taken.size());
  for (std::size_t p = 0; p < survey.places.size() && columns > 0; ++p) {
    const PlaceFrames& place = survey.places[p];
    const auto split = static_cast<std::size_t>(place.split);
    std::vector<int> read;
    for (const int n : place.numbers) {
      if (taken[split][static_cast<std::size_t>(n)]) read.push_back(n);
    }
    if (read.empty() || ++rows[split] > most_sheet_rows) continue;
    const auto count = std::min(read.size(), static_cast<std::size_t>(columns));
    for (std::size_t i = 0; i < count; ++i) figures.tiles[p][read[(2 * i + 1) * read.size() / (2 * count)]] = {};
  }
}

void read_split(const Dataset& dataset, const DatasetSurvey& survey, const MetadataIndex& metadata,
                const std::vector<bool>& taken, ImageFigures& figures, const std::function<void()>& after_frame) {
  const DatasetSplit& split = dataset.splits[static_cast<std::size_t>(metadata.split)];
  const auto s = static_cast<std::size_t>(metadata.split);
  std::mutex sums_mutex;
  parallel_for(static_cast<int>(split.blocks.size()), [&](int b) {
    const DatasetBlock& block = split.blocks[static_cast<std::size_t>(b)];
    const auto from = taken.begin() + block.first;
    if (std::find(from, from + block.frames, true) == from + block.frames) return;
    const std::vector<FrameInfo> infos = read_frames(metadata, block.first, block.frames);
    const auto wanted = [&](int number) { return taken[static_cast<std::size_t>(number)]; };
    read_block(dataset, block, wanted, [&](int number, const FramePixels& pixels) {
      const std::string fault = pixel_fault(dataset, pixels);
      if (!fault.empty()) {
        throw DataError(fmt::format("{} {} {:06}: {}", dataset.folder.string(), split.name, number, fault));
      }
      const FrameInfo& info = infos[static_cast<std::size_t>(number - block.first)];
      const auto n = static_cast<std::size_t>(number);
      const auto place = static_cast<std::size_t>(survey.place_of[s][n]);
      const PixelSums sums = sum_pixels(pixels, info.range_min_m, info.range_max_m, survey.bins);
      std::uint64_t in_mask = 0;
      for (const std::uint64_t pixels_set : sums.bin_mask) in_mask += pixels_set;
      figures.mask_share[s][n] = static_cast<double>(in_mask) / static_cast<double>(pixels.mask.size());
      if (split.name == "train") {
        const auto& numbers = figures.train_numbers;
        const auto slot = std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin();
        figures.train_thumbnails[static_cast<std::size_t>(slot)] = thumbnail_of(pixels.clean);
      }
      if (const auto tile = figures.tiles[place].find(number); tile != figures.tiles[place].end()) {
        tile->second = tile_of(pixels, number);
      }
      const std::scoped_lock lock(sums_mutex);
      figures.sums[place] += sums;
      after_frame();
    });
  });
}

}  // namespace

ImageFigures read_images(const Dataset& dataset, const DatasetSurvey& survey,
                         const std::vector<MetadataIndex>& metadata, const std::vector<std::vector<bool>>& taken,
                         int columns, const std::function<void(int, int)>& on_progress) {
  ImageFigures figures;
  figures.sums.resize(survey.places.size());
  figures.tiles.resize(survey.places.size());
  want_tiles(survey, taken, columns, figures);
  int total = 0, done = 0;
  for (std::size_t s = 0; s < taken.size(); ++s) {
    figures.mask_share.emplace_back(taken[s].size());
    total += static_cast<int>(std::count(taken[s].begin(), taken[s].end(), true));
    if (dataset.splits[s].name != "train") continue;
    for (std::size_t n = 0; n < taken[s].size(); ++n) {
      if (taken[s][n]) figures.train_numbers.push_back(static_cast<int>(n));
    }
    figures.train_thumbnails.resize(figures.train_numbers.size());
  }
  for (std::size_t s = 0; s < taken.size(); ++s) {
    read_split(dataset, survey, metadata[s], taken[s], figures, [&] { on_progress(++done, total); });
  }
  return figures;
}

}  // namespace ensonify
