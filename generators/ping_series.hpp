#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/speckle_figures.hpp"

namespace ensonify {

/// Images of pings in the order in which they were taken: `raw` of a split of a dataset, or a folder of PNG files in
/// the order of their names.
struct PingSeries {
  std::string name;  ///< of the dataset, or of the folder without those above it
  std::filesystem::path folder;
  std::vector<std::string> files;   ///< of a folder; of a dataset the frames' numbers, six digits
  std::vector<std::string> places;  ///< of a dataset, a frame
  std::vector<Pose> T_world_sonar;  ///< of a dataset, a frame
  std::optional<Dataset> dataset;
  int split = 0;

  int count() const { return static_cast<int>(files.size()); }
  /// Whether images i and i + 1 may be compared as two pings of one place.
  bool follow(int i) const;
  /// Whether the sonar stood still between i and i + 1: within 1 mm and 0.01 deg. None where no poses are known.
  std::optional<bool> still(int i) const;
};

/// Opens a folder. Of a dataset, the split of that name. Throws DataError: no such folder, neither a dataset nor PNG
/// files in it, an unfinished dataset; ConfigError: the dataset has no such split.
PingSeries open_pings(const std::filesystem::path& folder, const std::string& split);

/// Greyscale, 8 or 16 bits, at least as large as a tile (even_tiles.hpp), at most 2^24 pixels. Throws DataError naming
/// file and rule.
GreyImage read_ping(const PingSeries& pings, int i);

/// At most `most` images, spread evenly in neighbouring pairs; ascending.
std::vector<int> spread_pairs(int count, int most);

}  // namespace ensonify
