#include "ensonify/filters/opencv_filters.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>
#include <vector>

#include "ensonify/filters/mat_view.hpp"
#include "ensonify/filters/window_sums.hpp"

namespace ensonify {
namespace {

/// OpenCV has windows above 5 for 8 bits only.
Image2<float> median_of_reals(const Image2<float>& wide, int window) {
  Image2<float> out(wide.rows() - window + 1, wide.columns() - window + 1);
  std::vector<float> values;
  for (int i = 0; i < out.rows(); ++i) {
    for (int j = 0; j < out.columns(); ++j) {
      values.clear();
      for (int y = i; y < i + window; ++y) {
        const auto row = wide.row(y);
        values.insert(values.end(), row.begin() + j, row.begin() + j + window);
      }
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      out(i, j) = *middle;
    }
  }
  return out;
}

}  // namespace

Image2<float> apply(const Median& f, const GreyImage& image) {
  const int radius = f.window.radius();
  const Image2<float> wide = mirrored_border(image.grey, radius);
  cv::Mat mat = mat_view(wide), blurred;
  if (image.depth == GreyDepth::bits8) {
    mat.convertTo(mat, CV_8U);
  } else if (f.window.pixels > 5) {
    return median_of_reals(wide, f.window.pixels);
  }
  cv::medianBlur(mat, blurred, f.window.pixels);
  return from_mat(blurred, radius);
}

Image2<float> apply(const Bilateral& f, const GreyImage& image) {
  const int radius = f.window.radius();
  cv::Mat smoothed;
  cv::bilateralFilter(mat_view(mirrored_border(image.grey, radius)), smoothed, f.window.pixels, f.sigma_range,
                      f.sigma_space);
  return from_mat(smoothed, radius);
}

Image2<float> apply(const Nlm& f, const GreyImage& image) {
  constexpr double steps = 256.0;
  cv::Mat whole, smoothed;
  mat_view(image.grey).convertTo(whole, CV_16U, steps);
  cv::fastNlMeansDenoising(whole, smoothed, std::vector<float>{static_cast<float>(f.h * steps)}, f.patch.pixels,
                           f.search.pixels, cv::NORM_L1);
  smoothed.convertTo(smoothed, CV_32F, 1.0 / steps);
  return from_mat(smoothed);
}

}  // namespace ensonify
