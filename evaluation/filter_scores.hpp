#pragma once

#include <string>
#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/evaluation/ghost_scores.hpp"
#include "ensonify/evaluation/intervals.hpp"
#include "ensonify/evaluation/mask_scores.hpp"

namespace ensonify {

/// Share of the direct echoes' pixels that a filter keeps where the multipath it removes is measured: by a threshold of
/// its own, chosen on the frames that are scored, as for a point of a ROC curve.
constexpr double kept_beside_ghosts = 0.9;

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
  GhostLevels ghosts;
  double time_ms = 0;  ///< of the filter alone
};

/// Scores of `filtered` (levels may lie outside 0..255: they are held to it) with the mask "level >= t".
FrameScores score_frame(const Image2<float>& filtered, const FrameTruth& truth, int t);

/// A filter's frames of one scene, or of all, put together: means over frames; mask figures of the pooled pixels.
struct FilterScores {
  std::string filter, preset, scene;  ///< scene "all": every one
  int t = 0;                          ///< chosen on the val split
  Estimate psnr_db, ssim, edge_preservation, looks, gated_psnr_db, masked_psnr_db, masked_ssim;
  Estimate precision, recall, iou, f1;
  Estimate ghosts_removed;  ///< share of its energy; NaN where there is no multipath
  double time_ms = 0;       ///< median
  LevelCounts levels;
};

/// One entry a scene, in the order of their names, and "all" first.
std::vector<FilterScores> pool_scores(const std::string& filter, const std::string& preset, int t,
                                      const std::vector<FrameScores>& frames);

}  // namespace ensonify
