#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ensonify {

struct VerifyReport {
  int frames = 0;
  int grids = 0;
  std::vector<std::string> faults;  ///< empty: the dataset is whole and as its manifest says; at most 100 are listed
};

/// Reads a whole dataset back: every file there and no other, decodable, of one size; mask == (clean >= threshold) in
/// every pixel; hashes of frames, shards, grids and the root as in the manifest; and every file byte for byte as
/// checksums.txt says, but for the PNG files of frames, whose pixels count. Throws DataError where there is no manifest
/// or a broken one. Reads nothing outside of the folder.
VerifyReport verify_dataset(const std::filesystem::path& folder,
                            const std::function<void(int done, int total)>& on_progress);

}  // namespace ensonify
