#include "ensonify/evaluation/ghost_scores.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ensonify/core/echo.hpp"

namespace ensonify {

GhostLevels& GhostLevels::operator+=(const GhostLevels& other) {
  for (std::size_t step = 0; step < echoes.size(); ++step) {
    echoes[step] += other.echoes[step];
    ghosts[step] += other.ghosts[step];
  }
  return *this;
}

double GhostLevels::all_echoes() const { return echoes_kept(0); }
double GhostLevels::all_ghosts() const { return ghosts_removed(static_cast<int>(ghosts.size())); }

double GhostLevels::echoes_kept(int step) const {
  return static_cast<double>(std::accumulate(echoes.begin() + step, echoes.end(), std::uint64_t{0}));
}

double GhostLevels::ghosts_removed(int step) const {
  return std::accumulate(ghosts.begin(), ghosts.begin() + step, 0.0);
}

int GhostLevels::step_keeping(double share) const {
  int step = static_cast<int>(echoes.size()) - 1;
  while (step > 0 && echoes_kept(step) < share * all_echoes()) --step;
  return step;
}

GhostLevels ghost_levels(const Image2<float>& filtered, const Image2<float>& raw, const Image2<std::uint8_t>& labels) {
  GhostLevels levels;
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    const bool echo = labels.pixels()[i] == static_cast<std::uint8_t>(PixelLabel::direct);
    const bool ghost = labels.pixels()[i] == static_cast<std::uint8_t>(PixelLabel::multipath);
    if (!echo && !ghost) continue;
    const float share = std::clamp(filtered.pixels()[i], 0.0F, 255.0F) / 255.0F;
    const auto step = static_cast<std::size_t>(255.0F * std::sqrt(share));
    if (echo) ++levels.echoes[step];
    if (ghost) levels.ghosts[step] += static_cast<double>(raw.pixels()[i]) * raw.pixels()[i];
  }
  return levels;
}

}  // namespace ensonify
