#pragma once

#include <functional>
#include <map>
#include <vector>

#include "ensonify/generators/dataset_survey.hpp"
#include "ensonify/generators/perceptual_hash.hpp"
#include "ensonify/output/contact_sheet.hpp"

namespace ensonify {

/// What the images of a dataset's frames give. Every frame writes to its own place; sums are of whole numbers, so that
/// the order in which frames are read does not matter.
struct ImageFigures {
  std::vector<PixelSums> sums;                    ///< a place
  std::vector<std::vector<double>> mask_share;    ///< [split][number]; 0 where not read
  std::vector<int> train_numbers;                 ///< of the frames read in the split named train, ascending
  std::vector<Thumbnail> train_thumbnails;        ///< of their clean images
  std::vector<std::map<int, ContactTile>> tiles;  ///< a place, by number: raw beside mask of some frames
};

/// Reads the frames taken ([split][number]) and of every place makes at most `columns` tiles. Throws DataError naming
/// file and rule where a file is missing or broken.
ImageFigures read_images(const Dataset& dataset, const DatasetSurvey& survey,
                         const std::vector<MetadataIndex>& metadata, const std::vector<std::vector<bool>>& taken,
                         int columns, const std::function<void(int done, int total)>& on_progress);

}  // namespace ensonify
