#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensonify/generators/distribution_summary.hpp"
#include "ensonify/generators/even_tiles.hpp"
#include "ensonify/generators/level_figures.hpp"
#include "ensonify/generators/ping_series.hpp"

namespace ensonify {

struct NamedRegion {
  std::string name;
  Region region;
};

/// An even tile of an image and its speckle.
struct TileFigures {
  int image = 0;  ///< of the series
  Tile tile;
  SpeckleFigures speckle;
};

/// A tile of any kind, but none of the first 64 rows (ring-down), in two pings that follow each other: how their
/// normalised speckle correlates.
struct TilePair {
  double mean_level = 0;
  double correlation = 0;
};

struct RegionFigures {
  NamedRegion named;
  SpeckleFigures speckle;              ///< medians over images
  std::optional<double> ping_to_ping;  ///< median over pairs; none without pairs
};

/// Pairs of pings that follow each other; of a dataset only those where the sonar stood still, if there are any.
struct PingToPing {
  int pairs = 0;
  std::optional<bool> still;           ///< none: poses are not known, or there is no pair
  std::vector<TilePair> tiles;         ///< from the darkest to the brightest
  std::optional<double> bright, dark;  ///< medians over the brightest and the darkest quarter of the tiles
};

/// Statistics of the images of one side.
struct SideFigures {
  std::string name;
  bool dataset = false;
  std::string split;  ///< of a dataset
  int images = 0;
  int rows = 0, columns = 0;       ///< of the first image read
  std::vector<int> read;           ///< the images read, ascending
  std::vector<std::string> files;  ///< their names
  LevelSums levels;
  double least_level = 0;  ///< of the options
  std::vector<TileFigures> tiles;
  std::optional<SpeckleFigures> even;  ///< medians over tiles; none without tiles
  Histogram normalised;                ///< of all pixels of the tiles, each tile's of mean 1
  PingToPing ping_to_ping;
  std::vector<RegionFigures> regions;
};

struct AgainstOptions {
  int max_images = 64;  ///< most images that are read of a side, spread evenly in neighbouring pairs
  double least_level = default_least_level;  ///< mean of an even tile
  std::vector<NamedRegion> regions;
};

/// Reads a series and describes it; the result does not depend on the number of threads. Throws DataError where an
/// image is broken, ConfigError where a region lies outside of an image.
SideFigures describe_side(const PingSeries& pings, const AgainstOptions& options,
                          const std::function<void(int done, int total)>& on_progress);

}  // namespace ensonify
