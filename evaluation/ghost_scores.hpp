#pragma once

#include <array>
#include <cstdint>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Energy (raw level squared) of the pixels labelled multipath, by the grey level that a filter gives them, cut to
/// whole numbers and held to 0..255: what thresholds of the filter remove of it.
struct GhostEnergy {
  std::array<double, 256> at_level{};

  double all() const;
  /// Of the pixels below level t.
  double removed(int t) const;
};

GhostEnergy ghost_energy(const Image2<float>& filtered, const Image2<float>& raw, const Image2<std::uint8_t>& labels);

}  // namespace ensonify
