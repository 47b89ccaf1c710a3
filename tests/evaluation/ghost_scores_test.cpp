#include "ensonify/evaluation/ghost_scores.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "ensonify/core/echo.hpp"

namespace ensonify {
namespace {

/// Two ghosts of raw levels 3 and 4 that the filter gives 10.9 and 300, held to 255; echoes and noise count nowhere.
TEST(GhostScores, EnergyIsTheRawLevelsBelowTheThreshold) {
  Image2<float> filtered(1, 4), raw(1, 4);
  Image2<std::uint8_t> labels(1, 4);
  constexpr auto ghost = static_cast<std::uint8_t>(PixelLabel::multipath);
  constexpr auto echo = static_cast<std::uint8_t>(PixelLabel::direct);
  for (const auto& [column, level, of_raw, label] :
       {std::tuple{0, 10.9F, 3.0F, ghost}, {1, 300.0F, 4.0F, ghost}, {2, 5.0F, 9.0F, echo}, {3, 5.0F, 9.0F, {}}}) {
    filtered(0, column) = level;
    raw(0, column) = of_raw;
    labels(0, column) = label;
  }
  const GhostEnergy energy = ghost_energy(filtered, raw, labels);
  EXPECT_DOUBLE_EQ(energy.all(), 9.0 + 16.0);
  EXPECT_DOUBLE_EQ(energy.removed(10), 0.0);
  EXPECT_DOUBLE_EQ(energy.removed(11), 9.0);
  EXPECT_DOUBLE_EQ(energy.removed(255), 9.0);
}

}  // namespace
}  // namespace ensonify
