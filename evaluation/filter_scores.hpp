#pragma once

#include <string>
#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/evaluation/ghost_scores.hpp"
#include "ensonify/evaluation/intervals.hpp"
#include "ensonify/evaluation/mask_scores.hpp"

namespace ensonify {

/// Share of the direct echoes' pixels that a filter must keep where the multipath it removes is measured.
constexpr double kept_beside_ghosts = 0.9;

/// Grey levels from which on pixels are set, chosen on the val split.
struct MaskThresholds {
  int best = 1;     ///< greatest IoU
  int keeping = 1;  ///< the greatest that keeps kept_beside_ghosts
};

/// A frame's images, levels of 0..255.
struct FrameTruth {
  const Image2<float>&raw, &clean;
  const Image2<std::uint8_t>&mask, &labels;
};

/// What a filter makes of one frame.
struct FrameScores {
  int frame = 0;  ///< within the split
  std::string scene;
  double psnr_db = 0, ssim = 0, edge_preservation = 0, looks = 0;
  double gated_psnr_db = 0;  ///< of the filtered image where its own mask is set, 0 elsewhere
  /// Of the raw image where the filter's mask is set, 0 elsewhere: the paper's use of a mask.
  double masked_psnr_db = 0, masked_ssim = 0;
  MaskCounts mask;
  LevelCounts levels;
  double kept = 0, echoes = 0;            ///< pixels of direct echoes at the threshold `keeping`, and all
  double ghosts_removed = 0, ghosts = 0;  ///< energy of multipath below that threshold, and all
  double time_ms = 0;                     ///< of the filter alone
};

/// Scores of `filtered` (levels may lie outside 0..255: they are held to it) with masks "level >= threshold".
FrameScores score_frame(const Image2<float>& filtered, const FrameTruth& truth, MaskThresholds thresholds);

/// A filter's frames of one scene, or of all, put together: means over frames; mask figures of the pooled pixels.
struct FilterScores {
  std::string filter, preset, scene;  ///< scene "all": every one
  MaskThresholds t;
  Estimate psnr_db, ssim, edge_preservation, looks, gated_psnr_db, masked_psnr_db, masked_ssim;
  Estimate precision, recall, iou, f1;
  Estimate kept, ghosts_removed;  ///< shares; NaN where there is no multipath
  double time_ms = 0;             ///< median
  LevelCounts levels;
};

/// One entry a scene, in the order of their names, and "all" first.
std::vector<FilterScores> pool_scores(const std::string& filter, const std::string& preset, MaskThresholds t,
                                      const std::vector<FrameScores>& frames);

}  // namespace ensonify
