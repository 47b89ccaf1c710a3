#include "ensonify/evaluation/ghost_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>

#include "ensonify/core/echo.hpp"

namespace ensonify {
namespace {

/// Two ghosts of raw levels 3 and 4, to which the filter gives 10.9 and 300 (held to 255), and four echoes in
/// the middle of steps; step k begins at 255 (k / 255)^2.
TEST(GhostScores, EnergyIsTheRawLevelsBelowTheThresholdThatKeepsTheEchoes) {
  constexpr auto ghost = static_cast<std::uint8_t>(PixelLabel::multipath);
  constexpr auto echo = static_cast<std::uint8_t>(PixelLabel::direct);
  Image2<float> filtered(1, 7), raw(1, 7, 9.0F);
  Image2<std::uint8_t> labels(1, 7);
  for (int i = 0; i < 4; ++i) {  // steps 20, 40, 80, 160 and a half
    const double k = 20.5 * (1 << i);
    filtered(0, i) = static_cast<float>(255.0 * (k / 255.0) * (k / 255.0));
    labels(0, i) = echo;
  }
  for (const auto& [column, level, of_raw] : {std::tuple{4, 10.9F, 3.0F}, {5, 300.0F, 4.0F}}) {
    filtered(0, column) = level;
    raw(0, column) = of_raw;
    labels(0, column) = ghost;
  }
  filtered(0, 6) = 50.0F;  // noise
  const GhostLevels levels = ghost_levels(filtered, raw, labels);
  EXPECT_DOUBLE_EQ(levels.all_echoes(), 4.0);
  EXPECT_DOUBLE_EQ(levels.all_ghosts(), 9.0 + 16.0);
  const int ghost_step = static_cast<int>(255.0 * std::sqrt(10.9 / 255.0));  // 52
  EXPECT_DOUBLE_EQ(levels.ghosts_removed(ghost_step), 0.0);
  EXPECT_DOUBLE_EQ(levels.ghosts_removed(ghost_step + 1), 9.0);
  EXPECT_DOUBLE_EQ(levels.ghosts_removed(255), 9.0);
  for (const auto& [share, kept] : {std::pair{1.0, 4.0}, {0.75, 3.0}, {0.6, 3.0}, {0.25, 1.0}}) {
    const int step = levels.step_keeping(share);
    EXPECT_DOUBLE_EQ(levels.echoes_kept(step), kept) << share;
    EXPECT_LT(levels.echoes_kept(step + 1), share * 4.0) << share;
  }
  EXPECT_EQ(GhostLevels{}.step_keeping(0.9), 255);
}

}  // namespace
}  // namespace ensonify
