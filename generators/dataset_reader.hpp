#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/generators/dataset_plan.hpp"
#include "ensonify/generators/frame_pixels.hpp"
#include "ensonify/output/exr.hpp"

namespace ensonify {

/// Consecutive frames that lie together: of one tar in a WebDataset.
struct DatasetBlock {
  int split = 0;
  int number_in_split = 0;
  int first = 0;  ///< number within the split
  int frames = 0;
  std::string sha256;
};

/// A place that the recipe asks for.
struct DatasetPlace {
  std::string name, scene;
  std::uint64_t layout = 0;
};

struct DatasetSplit {
  std::string name;
  int frames = 0;
  std::vector<DatasetPlace> places;
  std::vector<DatasetBlock> blocks;
};

/// What the manifest of a finished dataset says, checked; no image is read. The splits stand in the order of the
/// frames' indices.
struct Dataset {
  std::filesystem::path folder;
  std::string manifest;  ///< JSON text
  std::string name, title, root_hash;
  SampleFormat format = SampleFormat::folder;
  int mask_threshold = 0;  ///< grey level
  int raw_bits = 8;
  int beams = 0;
  int range_bins = 0;  ///< 0: differs from frame to frame
  std::vector<DatasetSplit> splits;

  int frames() const;
};

/// Opens a dataset of either format. Throws DataError: none there, unfinished, or a broken manifest.
Dataset open_dataset(const std::filesystem::path& folder);

/// A line of metadata.jsonl: what most readers ask for, and the whole of it.
struct FrameInfo {
  int split = 0;
  int number = 0;  ///< within the split
  std::string place;
  double range_min_m = 0, range_max_m = 0;
  std::optional<double> time_s;  ///< empty for random poses
  Pose T_world_sonar = Pose::Identity();
  Pose T_world_sonar_est = Pose::Identity();
  std::vector<std::pair<std::string, double>> sampled;
  std::string line;  ///< JSON text
};

/// Where every line of a split's metadata.jsonl starts, so that any part can be read without holding the whole.
struct MetadataIndex {
  std::filesystem::path file;
  int split = 0;
  std::vector<std::uint64_t> starts;  ///< bytes; one more than lines
};

/// Throws DataError where the file is missing or has not one line a frame.
MetadataIndex index_metadata(const Dataset& dataset, int split);

/// Lines [first, first + count) as they are.
std::vector<std::string> read_lines(const MetadataIndex& index, int first, int count);

/// The same, read. Throws DataError with file and line number where a line breaks a rule.
std::vector<FrameInfo> read_frames(const MetadataIndex& index, int first, int count);

/// Calls visit(number, pixels) for every frame of a block for which wanted(number), in order; one frame is in memory
/// at a time. Images that `which` leaves out stay empty. Throws DataError naming the file that is missing, broken or
/// out of place.
void read_block(const Dataset& dataset, const DatasetBlock& block, const std::function<bool(int number)>& wanted,
                const std::function<void(int number, const FramePixels& pixels)>& visit, const FrameKinds& which = {});

/// The images of one frame. Of a WebDataset this reads the frame's shard: read_block is for many.
FramePixels read_pixels(const Dataset& dataset, int split, int number, const FrameKinds& which = {});

/// Channels of truth/*.exr (docs/datasets.md). Throws DataError where the dataset has none.
std::vector<Channel> read_truth(const Dataset& dataset, int split, int number);

/// What is wrong with the images of a frame: of another size than the manifest's, a mask that is not clean >= the
/// threshold, a label that the legend has not. Empty where nothing is.
std::string pixel_fault(const Dataset& dataset, const FramePixels& pixels);

}  // namespace ensonify
