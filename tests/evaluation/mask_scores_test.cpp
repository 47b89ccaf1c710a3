#include "ensonify/evaluation/mask_scores.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ensonify {
namespace {

TEST(MaskScores, FiguresAreTheirDefinitions) {
  const MaskCounts counts{6, 2, 4};
  EXPECT_DOUBLE_EQ(counts.precision(), 6.0 / 8.0);
  EXPECT_DOUBLE_EQ(counts.recall(), 6.0 / 10.0);
  EXPECT_DOUBLE_EQ(counts.iou(), 6.0 / 12.0);
  EXPECT_DOUBLE_EQ(counts.f1(), 12.0 / 18.0);
  EXPECT_TRUE(std::isnan(MaskCounts{}.precision()));
  EXPECT_TRUE(std::isnan(MaskCounts{}.iou()));
}

/// For every threshold the same as comparing pixel by pixel, levels beyond 0..255 included.
RC_GTEST_PROP(MaskScores, CountsOfLevelsGiveEveryThresholdsMask, ()) {
  Image2<float> image(9, 11);
  Image2<std::uint8_t> mask(9, 11);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.pixels()[i] = static_cast<float>(*rc::gen::inRange(-40, 1200)) / 4.0F;
    mask.pixels()[i] = *rc::gen::element<std::uint8_t>(0, 255);
  }
  const LevelCounts levels = count_levels(image, mask);
  const int t = *rc::gen::inRange(1, 256);
  MaskCounts expected;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const bool set = image.pixels()[i] >= static_cast<float>(t), truth = mask.pixels()[i] != 0;
    expected += {set && truth, set && !truth, !set && truth};
  }
  const MaskCounts counts = levels.at(t);
  RC_ASSERT(counts.true_positive == expected.true_positive);
  RC_ASSERT(counts.false_positive == expected.false_positive);
  RC_ASSERT(counts.false_negative == expected.false_negative);
  const double best = levels.at(levels.best_threshold()).iou();
  for (int other = 1; other < 256; ++other) {
    RC_ASSERT(!(levels.at(other).iou() > best));
  }
}

}  // namespace
}  // namespace ensonify
