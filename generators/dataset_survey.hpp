#pragma once

#include <map>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/pixel_sums.hpp"

namespace ensonify {

/// What the metadata of a place's frames says, a column a value, in the order of the frames.
struct PlaceFrames {
  int split = 0;
  DatasetPlace place;
  std::vector<int> numbers;                            ///< within the split
  std::map<std::string, std::vector<double>> poses;    ///< depth_m, roll_deg, pitch_deg, yaw_deg
  std::map<std::string, std::vector<double>> sampled;  ///< a key may be missing in some frames
  /// Of a trajectory, along its frames; empty for random poses.
  struct Way {
    double duration_s, length_m;
    double drift_m;  ///< dead-reckoned from true position at the last frame
  };
  std::optional<Way> way;
};

/// The metadata of all frames; about 100 bytes a frame.
struct DatasetSurvey {
  std::vector<PlaceFrames> places;         ///< as the recipe asks for, in its order; some may have no frame
  std::vector<std::vector<int>> place_of;  ///< [split][number] -> index into places
  RangeBins bins;                          ///< rows where all frames share a window, else 256 over all windows
};

/// Reads every line of metadata. Throws DataError, also where a frame's place is not in its split of the recipe.
DatasetSurvey survey_metadata(const Dataset& dataset, const std::vector<MetadataIndex>& metadata);

/// At most `most` frames (0: all) as [split][number] -> taken; spread evenly over every place's frames, at least one
/// each. Throws ConfigError where there are more places than that.
std::vector<std::vector<bool>> spread_frames(const DatasetSurvey& survey, int most);

}  // namespace ensonify
