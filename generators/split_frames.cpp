#include "ensonify/generators/split_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

/// Every place's frames of one split.
struct SplitPlaces {
  int split = 0;
  std::vector<std::string> scene_of;
  std::vector<std::vector<int>> numbers;
};

SplitPlaces places_of(const Dataset& dataset, const std::string& name) {
  const auto found = std::ranges::find(dataset.splits, name, &DatasetSplit::name);
  if (found == dataset.splits.end() || found->frames == 0) {
    throw ConfigError(
        fmt::format("{}: has no frames in a split '{}', which is needed: thresholds are chosen on val, "
                    "scores taken on test",
                    dataset.folder.string(), name));
  }
  SplitPlaces result;
  result.split = static_cast<int>(found - dataset.splits.begin());
  const MetadataIndex metadata = index_metadata(dataset, result.split);
  std::vector<std::string> names;
  for (const FrameInfo& info : read_frames(metadata, 0, found->frames)) {
    result.scene_of.push_back(info.place);
    const auto at = std::ranges::find(names, info.place);
    if (at == names.end()) {
      names.push_back(info.place);
      result.numbers.emplace_back();
    }
    result.numbers[static_cast<std::size_t>(std::ranges::find(names, info.place) - names.begin())].push_back(
        info.number);
  }
  return result;
}

}  // namespace

SplitFrames choose_frames(const Dataset& dataset, const std::string& split, int most) {
  SplitPlaces places = places_of(dataset, split);
  SplitFrames frames{places.split, {}, std::move(places.scene_of)};
  const auto place_count = places.numbers.size();
  for (std::size_t p = 0; p < place_count; ++p) {
    const auto& numbers = places.numbers[p];
    const std::size_t share = (static_cast<std::size_t>(most) + place_count - 1 - p) / place_count;
    const std::size_t count = most == 0 ? numbers.size() : std::min(numbers.size(), std::max<std::size_t>(share, 1));
    for (std::size_t i = 0; i < count; ++i)
      frames.numbers.push_back(numbers[(2 * i + 1) * numbers.size() / (2 * count)]);
  }
  std::ranges::sort(frames.numbers);
  return frames;
}

SplitFrames middle_frames(const Dataset& dataset, const std::string& split) { return choose_frames(dataset, split, 1); }

void visit_frames(const Dataset& dataset, const SplitFrames& frames,
                  const std::function<void(int, const JudgedFrame&)>& visit) {
  const auto& blocks = dataset.splits[static_cast<std::size_t>(frames.split)].blocks;
  parallel_for(static_cast<int>(blocks.size()), [&](int b) {
    const auto wanted = [&](int number) { return std::ranges::binary_search(frames.numbers, number); };
    read_block(dataset, blocks[static_cast<std::size_t>(b)], wanted, [&](int number, const FramePixels& pixels) {
      JudgedFrame frame{number,      frames.scene_of[static_cast<std::size_t>(number)],
                        {},          to_grey(pixels.clean).grey,
                        pixels.mask, pixels.labels};
      frame.raw = std::visit([](const auto& raw) { return to_grey(raw); }, pixels.raw);
      visit(static_cast<int>(std::ranges::lower_bound(frames.numbers, number) - frames.numbers.begin()), frame);
    });
  });
}

}  // namespace ensonify
