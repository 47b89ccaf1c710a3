#include "ensonify/evaluation/ghost_scores.hpp"

#include <algorithm>
#include <numeric>

#include "ensonify/core/echo.hpp"

namespace ensonify {

double GhostEnergy::all() const { return std::accumulate(at_level.begin(), at_level.end(), 0.0); }

double GhostEnergy::removed(int t) const { return std::accumulate(at_level.begin(), at_level.begin() + t, 0.0); }

GhostEnergy ghost_energy(const Image2<float>& filtered, const Image2<float>& raw, const Image2<std::uint8_t>& labels) {
  GhostEnergy energy;
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    if (labels.pixels()[i] != static_cast<std::uint8_t>(PixelLabel::multipath)) continue;
    const auto level = static_cast<std::size_t>(std::clamp(filtered.pixels()[i], 0.0F, 255.0F));
    energy.at_level[level] += static_cast<double>(raw.pixels()[i]) * raw.pixels()[i];
  }
  return energy;
}

}  // namespace ensonify
