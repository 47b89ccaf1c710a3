#include "ensonify/generators/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

constexpr double normalised_high = 3;
constexpr int normalised_bins = 75;
constexpr int least_region = 16;

/// What one image gives, and it with the one after it.
struct ImageResult {
  int rows = 0, columns = 0;
  LevelSums levels;
  std::vector<TileFigures> tiles;
  std::vector<std::uint64_t> normalised;
  std::vector<SpeckleFigures> regions;
  bool paired = false;
  std::vector<TilePair> tile_pairs;
  std::vector<double> region_pairs;
};

RandomKey key_of(int image) {
  return RandomKey::from_seed(0).child("against").child(static_cast<std::uint64_t>(image));
}

Image2<double> speckle_of(const GreyImage& image, const Region& region, int number) {
  return normalised_speckle(image, region, key_of(number).child("jitter"));
}

void check_region(const NamedRegion& named, const GreyImage& image, const PingSeries& pings, int number) {
  const Region& r = named.region;
  const int rows = image.grey.rows(), columns = image.grey.columns();
  if (r.within(rows, columns) && r.rows() >= least_region && r.columns() >= least_region) return;
  throw ConfigError(
      fmt::format("region {}: rows {} to {}, columns {} to {} must lie within the {} rows and {} columns of {} {} and "
                  "hold {} of each at least",
                  named.name, r.row0, r.row1, r.column0, r.column1, rows, columns, pings.name,
                  pings.files[static_cast<std::size_t>(number)], least_region));
}

void add_tiles(const GreyImage& image, int number, double least_level, ImageResult& result) {
  std::vector<double> values;
  for (const Tile& tile : even_tiles(all_tiles(image), least_level)) {
    result.tiles.push_back({number, tile, speckle_figures(image, tile.region, key_of(number))});
    const auto tile_values = drawn_values(speckle_of(image, tile.region, number), key_of(number));
    values.insert(values.end(), tile_values.begin(), tile_values.end());
  }
  result.normalised = histogram(values, 0, normalised_high, normalised_bins).counts;
}

void compare(const GreyImage& image, const GreyImage& next, int number, const AgainstOptions& options,
             ImageResult& result) {
  const bool same = image.grey.rows() == next.grey.rows() && image.grey.columns() == next.grey.columns();
  if (!same) return;
  result.paired = true;
  const auto correlate = [&](const Region& region) {
    return correlation(speckle_of(image, region, number), speckle_of(next, region, number + 1));
  };
  const std::vector<Tile> tiles = all_tiles(image), next_tiles = all_tiles(next);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    // The first rows hold what the sonar rings with: dark, but the same in every ping, and no noise.
    if (tiles[t].region.row0 == 0) continue;
    result.tile_pairs.push_back({(tiles[t].mean_level + next_tiles[t].mean_level) / 2, correlate(tiles[t].region)});
  }
  for (const NamedRegion& named : options.regions) result.region_pairs.push_back(correlate(named.region));
}

ImageResult read_one(const PingSeries& pings, int number, bool with_next, const AgainstOptions& options) {
  const GreyImage image = read_ping(pings, number);
  ImageResult result;
  result.rows = image.grey.rows();
  result.columns = image.grey.columns();
  result.levels = sum_levels(image);
  add_tiles(image, number, options.least_level, result);
  for (const NamedRegion& named : options.regions) {
    check_region(named, image, pings, number);
    result.regions.push_back(speckle_figures(image, named.region, key_of(number)));
  }
  if (with_next) compare(image, read_ping(pings, number + 1), number, options, result);
  return result;
}

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return percentile(values, 50);
}

/// Whether each of the images read is compared with the next.
std::vector<bool> choose_pairs(const PingSeries& pings, const std::vector<int>& read, std::optional<bool>& still) {
  std::vector<bool> follows(read.size()), stands(read.size());
  for (std::size_t i = 0; i + 1 < read.size(); ++i) {
    follows[i] = read[i + 1] == read[i] + 1 && pings.follow(read[i]);
    stands[i] = follows[i] && pings.still(read[i]).value_or(false);
  }
  const auto any = [](const std::vector<bool>& v) { return std::find(v.begin(), v.end(), true) != v.end(); };
  if (pings.dataset && any(follows)) still = any(stands);
  return still.value_or(false) ? stands : follows;
}

void add_quarters(PingToPing& pings) {
  auto& tiles = pings.tiles;
  std::stable_sort(tiles.begin(), tiles.end(),
                   [](const TilePair& a, const TilePair& b) { return a.mean_level < b.mean_level; });
  const std::size_t quarter = std::max<std::size_t>(1, tiles.size() / 4);
  std::vector<double> dark, bright;
  for (std::size_t i = 0; i < std::min(quarter, tiles.size()); ++i) {
    dark.push_back(tiles[i].correlation);
    bright.push_back(tiles[tiles.size() - 1 - i].correlation);
  }
  pings.dark = median(std::move(dark));
  pings.bright = median(std::move(bright));
}

}  // namespace

SideFigures describe_side(const PingSeries& pings, const AgainstOptions& options,
                          const std::function<void(int, int)>& on_progress) {
  SideFigures side;
  side.name = pings.name;
  side.dataset = pings.dataset.has_value();
  if (side.dataset) side.split = pings.dataset->splits[static_cast<std::size_t>(pings.split)].name;
  side.images = pings.count();
  side.least_level = options.least_level;
  side.read = spread_pairs(pings.count(), options.max_images);
  for (const int i : side.read) side.files.push_back(pings.files[static_cast<std::size_t>(i)]);
  const std::vector<bool> paired = choose_pairs(pings, side.read, side.ping_to_ping.still);

  std::vector<ImageResult> results(side.read.size());
  std::mutex progress_mutex;
  int done = 0;
  parallel_for(static_cast<int>(results.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    results[at] = read_one(pings, side.read[at], paired[at], options);
    const std::scoped_lock lock(progress_mutex);
    on_progress(++done, static_cast<int>(side.read.size()));
  });

  side.rows = results.front().rows;
  side.columns = results.front().columns;
  side.normalised = histogram({}, 0, normalised_high, normalised_bins);
  std::vector<SpeckleFigures> even;
  for (const ImageResult& result : results) {
    side.levels += result.levels;
    for (const TileFigures& tile : result.tiles) even.push_back(tile.speckle);
    side.tiles.insert(side.tiles.end(), result.tiles.begin(), result.tiles.end());
    for (std::size_t b = 0; b < result.normalised.size(); ++b) side.normalised.counts[b] += result.normalised[b];
    side.ping_to_ping.pairs += result.paired ? 1 : 0;
    auto& tiles = side.ping_to_ping.tiles;
    tiles.insert(tiles.end(), result.tile_pairs.begin(), result.tile_pairs.end());
  }
  if (!even.empty()) side.even = median_figures(std::move(even));
  add_quarters(side.ping_to_ping);
  for (std::size_t r = 0; r < options.regions.size(); ++r) {
    std::vector<SpeckleFigures> speckle;
    std::vector<double> pairs;
    for (const ImageResult& result : results) {
      speckle.push_back(result.regions[r]);
      if (result.paired) pairs.push_back(result.region_pairs[r]);
    }
    side.regions.push_back({options.regions[r], median_figures(std::move(speckle)), median(std::move(pairs))});
  }
  return side;
}

}  // namespace ensonify
