#pragma once

#include <array>
#include <vector>

#include "ensonify/core/posed_image.hpp"
#include "ensonify/evaluation/map_scores.hpp"
#include "ensonify/generators/map_parts.hpp"
#include "ensonify/mapping/inverse_model.hpp"

namespace ensonify {

/// The maps of some pings by one model at all thresholds: their scores, and how they look from above.
struct ScoredMaps {
  std::vector<MapCounts> counts;                          ///< a threshold each
  std::vector<std::array<Image2<std::uint8_t>, 2>> seen;  ///< free and occupied cells (evaluation/map_picture.hpp)
};

/// `box` is a box of the truth's cells. Maps need at most `limit_bytes` at a time: the box is done in parts, with the
/// same result. Throws ConfigError where that does not do, DataError as ThresholdSweep.
ScoredMaps score_maps(const std::vector<PosedImage>& pings, const InverseModel& model,
                      const std::vector<double>& thresholds, const MapTruth& truth, const GridFrame& box,
                      double limit_bytes);

}  // namespace ensonify
