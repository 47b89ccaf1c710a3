#pragma once

#include <span>
#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// How an image goes on beyond its border.
enum class WindowBorder {
  mirror,  ///< reflected about the outermost pixel, which is not repeated ("reflect 101"), as often as needed
  zero,
};

/// Index in [0, n) of the mirrored position i.
int mirrored(int i, int n);

/// The image with `radius` mirrored pixels more on every side.
Image2<float> mirrored_border(const Image2<float>& image, int radius);

/// Mean and population variance of the (2 radius + 1)^2 window about every pixel, a row at a time from the top.
/// Sums of blocks (van Herk 1992, Gil and Werman 1993, for sums): three additions a pixel and direction for any radius,
/// and nothing is ever subtracted, so that zeros stay zeros beside bright pixels.
class WindowSums {
 public:
  WindowSums(const Image2<float>& image, int radius, WindowBorder border = WindowBorder::mirror);

  /// Of the next row; both spans are as long as the image is wide.
  void next_row(std::span<double> mean, std::span<double> variance);

 private:
  using Row = std::vector<double>;
  struct Sums {
    Row values, squares;
  };
  void add_row(int row, Sums& sums) const;
  void start_block();
  void across(const Row& columns, std::span<double> out);

  const Image2<float>& image_;
  int radius_, window_;
  WindowBorder border_;
  int row_ = 0;
  std::vector<Sums> from_;  ///< [k]: rows k.. of the block, summed
  Sums until_;              ///< rows of the next block so far
  Row run_, longer_;        ///< sums of so many neighbours from a column on
  Row columns_, squares_;
};

}  // namespace ensonify
