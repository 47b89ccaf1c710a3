#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/dataset_survey.hpp"

namespace ensonify {

/// A frame as filters are judged on it.
struct JudgedFrame {
  int number = 0;  ///< within the split
  std::string scene;
  GreyImage raw;
  Image2<float> clean;
  Image2<std::uint8_t> mask, labels;
};

/// Frames of one split, some or all.
struct SplitFrames {
  int split = 0;
  std::vector<int> numbers;           ///< ascending
  std::vector<std::string> scene_of;  ///< of every frame of the split
};

/// At most `most` frames of the split (0: all), evenly from each of its places. Throws ConfigError where there is no
/// such split, or no frame in it.
SplitFrames choose_frames(const Dataset& dataset, const std::string& split, int most);

/// The middle frame of every place.
SplitFrames middle_frames(const Dataset& dataset, const std::string& split);

/// Calls visit(position in numbers, frame) for every chosen frame, from several threads at once. Throws DataError
/// naming a file that is missing or broken.
void visit_frames(const Dataset& dataset, const SplitFrames& frames,
                  const std::function<void(int at, const JudgedFrame& frame)>& visit);

}  // namespace ensonify
