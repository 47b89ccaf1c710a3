#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/generators/dataset_survey.hpp"
#include "ensonify/generators/distribution_summary.hpp"
#include "ensonify/generators/pixel_sums.hpp"
#include "ensonify/generators/variety.hpp"
#include "ensonify/output/contact_sheet.hpp"

namespace ensonify {

constexpr std::array mask_share_percents{1, 5, 25, 50, 75, 95, 99};
constexpr double sparse_mask_share = 0.005;
constexpr double crowded_mask_share = 0.4;

/// Figures of some frames: of a place, a split or the whole set. What comes from pixels is of the frames read.
struct Figures {
  int frames = 0, frames_read = 0;
  Summary mask_share;
  std::array<double, mask_share_percents.size()> mask_share_percentiles{};
  double mask_share_below = 0;  ///< share of frames below sparse_mask_share
  double mask_share_above = 0;  ///< share of frames above crowded_mask_share
  PixelSums pixels;
  std::map<std::string, Summary> poses, sampled;  ///< of all frames
};

struct PlaceFigures {
  DatasetPlace place;
  std::string split;
  Figures figures;  ///< frames 0: the recipe asks for the place, and no frame is there
  std::optional<PlaceFrames::Way> way;
};

/// Of the split train.
struct TrainVariety {
  Variety variety;
  struct Pair {
    int a = 0, b = 0;  ///< numbers of the frames
    int distance = 0;
    double correlation = 0;
    std::string place_a, place_b;
    double apart_m = 0, turned_deg = 0;  ///< between the poses
  };
  std::vector<Pair> closest;
};

struct DatasetStats {
  std::string name, title, root_hash, format;
  RangeBins bins;
  Figures overall;
  std::vector<std::pair<std::string, Figures>> splits;
  std::vector<PlaceFigures> places;
  std::optional<TrainVariety> variety;                               ///< none without a split named train
  std::vector<std::pair<std::string, ContactSheet>> contact_sheets;  ///< a split
};

struct StatsOptions {
  int max_frames = 0;       ///< most frames whose images are read, spread evenly; 0: all
  int contact_columns = 8;  ///< frames of a place on the contact sheet; 0: no sheets
};

/// Reads a dataset and describes it. The result does not depend on the number of threads. Holds about 1.2 kB a training
/// frame and 0.1 kB any other, whatever the images' size. Throws DataError naming file and rule where a file is missing
/// or broken, ConfigError where max_frames is less than the places.
DatasetStats dataset_stats(const Dataset& dataset, const StatsOptions& options,
                           const std::function<void(int done, int total)>& on_progress);

}  // namespace ensonify
