#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ensonify/generators/frame.hpp"
#include "ensonify/output/folder_lock.hpp"

namespace ensonify {

enum class SampleFormat { folder, webdataset };

/// Consecutive frames of one split: the unit of work, of resuming and of distribution over machines.
struct Block {
  int index = 0;
  int split = 0;
  int first = 0;  ///< frame index over the dataset
  int frames = 0;
  int number_in_split = 0;
};

/// 16 frames a block in folders; 256 in WebDataset shards, one tar a block.
std::vector<Block> plan_blocks(const Recipe& recipe, SampleFormat format);

/// The recipe with everything it stands for (sonar, noise, hashes of the scene files), as JSON text: two datasets of
/// equal plan, seed and ISA are bit-identical.
std::string plan_json(const FrameMaker& maker, const std::string& isa, SampleFormat format);

/// Where a dataset keeps its parts.
struct DatasetPaths {
  std::filesystem::path root;

  std::filesystem::path manifest() const { return root / "dataset.json"; }
  std::filesystem::path state() const { return root / ".ensonify"; }
  std::filesystem::path plan() const { return state() / "plan.json"; }
  std::filesystem::path checksums() const { return root / "checksums.txt"; }
  std::filesystem::path block(int index) const;
  std::filesystem::path observed(int block) const;
  std::filesystem::path image(const std::string& split, const std::string& kind, int number) const;
  std::filesystem::path tar(const std::string& split, int number_in_split) const;
  std::filesystem::path grid(const std::string& place, const std::string& extension) const;
};

/// Whether a complete set of this plan is there.
bool is_complete(const DatasetPaths& paths, const std::string& plan);

/// Throws ConfigError where prepare_dataset() would for what the folder holds now; writes nothing.
void check_folder_for(const DatasetPaths& paths, const std::string& plan, bool force);

/// Makes the folder ready for this plan: new, or holding the same plan (then the work resumes). `force` first removes
/// a dataset of another plan. Throws ConfigError where the folder holds something else, or where another process works
/// on what `force` would remove. Keep the lock while working in the folder.
[[nodiscard]] FolderLock prepare_dataset(const DatasetPaths& paths, const std::string& plan, bool force);

}  // namespace ensonify
