#pragma once

#include <array>
#include <cstdint>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// What thresholds of a filter keep of the direct echoes and remove of the multipath: pixels labelled direct, and
/// energy (raw level squared) of the pixels labelled multipath, by the level the filter gives them. 256 steps of the
/// level's square root, fine where levels are low, as probabilities of faint echoes are: step k begins at 255 (k /
/// 255)^2.
struct GhostLevels {
  std::array<std::uint64_t, 256> echoes{};
  std::array<double, 256> ghosts{};

  GhostLevels& operator+=(const GhostLevels& other);
  double all_echoes() const;
  double all_ghosts() const;
  /// Of the pixels at the step or above.
  double echoes_kept(int step) const;
  /// Of the pixels below it.
  double ghosts_removed(int step) const;
  /// The greatest step that keeps that share of the echoes.
  int step_keeping(double share) const;
};

GhostLevels ghost_levels(const Image2<float>& filtered, const Image2<float>& raw, const Image2<std::uint8_t>& labels);

}  // namespace ensonify
