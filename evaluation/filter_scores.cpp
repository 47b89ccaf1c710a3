#include "ensonify/evaluation/filter_scores.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "ensonify/evaluation/image_scores.hpp"

namespace ensonify {
namespace {

Image2<float> held(const Image2<float>& image) {
  Image2<float> out = image;
  for (float& x : out.pixels()) x = std::clamp(x, 0.0F, 255.0F);
  return out;
}

Estimate mean_of(const std::vector<const FrameScores*>& frames, double FrameScores::*score) {
  std::vector<double> values;
  for (const FrameScores* frame : frames) values.push_back(frame->*score);
  return mean_estimate(values);
}

Estimate pooled(const std::vector<const FrameScores*>& frames, double (MaskCounts::*figure)() const) {
  const auto statistic = [&](std::span<const int> weights) {
    MaskCounts sum;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto weight = static_cast<std::uint64_t>(weights[i]);
      const MaskCounts& mask = frames[i]->mask;
      sum += {weight * mask.true_positive, weight * mask.false_positive, weight * mask.false_negative};
    }
    return (sum.*figure)();
  };
  return bootstrap_estimate(static_cast<int>(frames.size()), RandomKey::from_seed(0).child("pooled mask"), statistic);
}

/// The interval is that of the share at the threshold that all frames together give.
Estimate ghosts_removed(const std::vector<const FrameScores*>& frames) {
  GhostLevels sum;
  for (const FrameScores* frame : frames) sum += frame->ghosts;
  const int step = sum.step_keeping(kept_beside_ghosts);
  std::vector<std::pair<double, double>> of_frame;
  for (const FrameScores* frame : frames) {
    of_frame.emplace_back(frame->ghosts.ghosts_removed(step), frame->ghosts.all_ghosts());
  }
  const auto statistic = [&](std::span<const int> weights) {
    double removed = 0, all = 0;
    for (std::size_t i = 0; i < of_frame.size(); ++i) {
      removed += weights[i] * of_frame[i].first;
      all += weights[i] * of_frame[i].second;
    }
    return all > 0 ? removed / all : std::numeric_limits<double>::quiet_NaN();
  };
  return bootstrap_estimate(static_cast<int>(frames.size()), RandomKey::from_seed(0).child("ghosts"), statistic);
}

FilterScores pool(const std::vector<const FrameScores*>& frames) {
  FilterScores scores;
  scores.psnr_db = mean_of(frames, &FrameScores::psnr_db);
  scores.ssim = mean_of(frames, &FrameScores::ssim);
  scores.edge_preservation = mean_of(frames, &FrameScores::edge_preservation);
  scores.looks = mean_of(frames, &FrameScores::looks);
  scores.gated_psnr_db = mean_of(frames, &FrameScores::gated_psnr_db);
  scores.masked_psnr_db = mean_of(frames, &FrameScores::masked_psnr_db);
  scores.masked_ssim = mean_of(frames, &FrameScores::masked_ssim);
  scores.precision = pooled(frames, &MaskCounts::precision);
  scores.recall = pooled(frames, &MaskCounts::recall);
  scores.iou = pooled(frames, &MaskCounts::iou);
  scores.f1 = pooled(frames, &MaskCounts::f1);
  scores.ghosts_removed = ghosts_removed(frames);
  std::vector<double> times;
  for (const FrameScores* frame : frames) {
    scores.levels += frame->levels;
    times.push_back(frame->time_ms);
  }
  std::ranges::sort(times);
  scores.time_ms = times.empty() ? 0.0 : times[times.size() / 2];
  return scores;
}

}  // namespace

FrameScores score_frame(const Image2<float>& filtered, const FrameTruth& truth, int t) {
  const auto& [raw, clean, mask, labels] = truth;
  const Image2<float> image = held(filtered);
  Image2<float> masked(raw.rows(), raw.columns()), gated(raw.rows(), raw.columns());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (image.pixels()[i] < static_cast<float>(t)) continue;
    masked.pixels()[i] = raw.pixels()[i];
    gated.pixels()[i] = image.pixels()[i];
  }
  FrameScores scores;
  scores.psnr_db = psnr_db(image, clean);
  scores.ssim = ssim(image, clean);
  scores.edge_preservation = edge_preservation(image, clean);
  scores.looks = equivalent_looks(image, clean);
  scores.gated_psnr_db = psnr_db(gated, clean);
  scores.masked_psnr_db = psnr_db(masked, clean);
  scores.masked_ssim = ssim(masked, clean);
  scores.levels = count_levels(image, mask);
  scores.mask = scores.levels.at(t);
  scores.ghosts = ghost_levels(image, raw, labels);
  return scores;
}

std::vector<FilterScores> pool_scores(const std::string& filter, const std::string& preset, int t,
                                      const std::vector<FrameScores>& frames) {
  std::set<std::string> scenes;
  for (const FrameScores& frame : frames) scenes.insert(frame.scene);
  std::vector<std::string> names{"all"};
  names.insert(names.end(), scenes.begin(), scenes.end());
  std::vector<FilterScores> result;
  for (const std::string& scene : names) {
    std::vector<const FrameScores*> chosen;
    for (const FrameScores& frame : frames) {
      if (scene == "all" || frame.scene == scene) chosen.push_back(&frame);
    }
    FilterScores scores = pool(chosen);
    scores.filter = filter;
    scores.preset = preset;
    scores.scene = scene;
    scores.t = t;
    result.push_back(std::move(scores));
  }
  return result;
}

}  // namespace ensonify
