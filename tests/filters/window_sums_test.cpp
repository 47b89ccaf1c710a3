#include "ensonify/filters/window_sums.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ensonify {
namespace {

/// numpy.pad(mode="reflect") of 0 1 2 3, and of a single pixel.
TEST(WindowSums, TheBorderIsMirroredAsOftenAsNeeded) {
  const std::vector<int> expected{1, 2, 3, 2, 1, 0, 1, 2, 3, 2, 1, 0, 1, 2, 3};
  for (int i = -5; i < 10; ++i) EXPECT_EQ(mirrored(i, 4), expected[static_cast<std::size_t>(i + 5)]) << i;
  for (int i = -3; i < 4; ++i) EXPECT_EQ(mirrored(i, 1), 0);
}

RC_GTEST_PROP(WindowSums, MeanAndVarianceAreThoseOfTheWindow, ()) {
  const int rows = *rc::gen::inRange(1, 30), columns = *rc::gen::inRange(1, 30), radius = *rc::gen::inRange(1, 12);
  const WindowBorder border = *rc::gen::element(WindowBorder::mirror, WindowBorder::zero);
  Image2<float> image(rows, columns);
  for (float& x : image.pixels()) x = static_cast<float>(*rc::gen::inRange(0, 256));
  WindowSums sums(image, radius, border);
  std::vector<double> mean(image.columns()), variance(image.columns());
  for (int i = 0; i < rows; ++i) {
    sums.next_row(mean, variance);
    for (int j = 0; j < columns; ++j) {
      double sum = 0, squares = 0;
      for (int y = i - radius; y <= i + radius; ++y) {
        for (int x = j - radius; x <= j + radius; ++x) {
          const bool inside = y >= 0 && y < rows && x >= 0 && x < columns;
          const double v =
              inside || border == WindowBorder::mirror ? image(mirrored(y, rows), mirrored(x, columns)) : 0.0;
          sum += v;
          squares += v * v;
        }
      }
      const double n = std::pow(2.0 * radius + 1.0, 2);
      RC_ASSERT(std::abs(mean[j] - sum / n) < 1e-9);
      RC_ASSERT(std::abs(variance[j] - (squares / n - sum * sum / (n * n))) < 1e-7);
    }
  }
}

/// Zeros beside a bright pixel must stay zeros: running sums that subtract leave a rest.
TEST(WindowSums, NothingIsLeftOfABrightPixel) {
  Image2<float> image(40, 40);
  image(3, 3) = 1e6F + 0.1F;
  WindowSums sums(image, 2);
  std::vector<double> mean(40), variance(40);
  for (int i = 0; i < 40; ++i) {
    sums.next_row(mean, variance);
    for (int j = 0; j < 40; ++j) {
      const bool seen = i <= 5 && j <= 5;
      if (seen) continue;
      EXPECT_EQ(mean[j], 0.0) << i << " " << j;
      EXPECT_EQ(variance[j], 0.0);
    }
  }
}

}  // namespace
}  // namespace ensonify
