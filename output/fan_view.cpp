#include "ensonify/output/fan_view.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace ensonify {
namespace {

/// Fractional column of an azimuth between beam centres; outside the fan far off the image.
float column_of(const std::vector<double>& azimuth, double theta) {
  constexpr float outside = -10.0f;
  const auto after = std::lower_bound(azimuth.begin(), azimuth.end(), theta, std::greater<>{});
  if (after == azimuth.end() || (after == azimuth.begin() && *after != theta)) return outside;
  if (after == azimuth.begin()) return 0.0f;
  const double before = *(after - 1);
  const auto column = static_cast<double>(after - azimuth.begin()) - 1.0;
  return static_cast<float>(column + (before - theta) / (before - *after));
}

}  // namespace

Image2<std::uint8_t> fan_view(const Image2<std::uint8_t>& image, const SonarGeometry& geometry, int height) {
  const double widest =
      std::max(std::abs(geometry.beam_azimuth_rad.front()), std::abs(geometry.beam_azimuth_rad.back()));
  const int half_width =
      std::max(1, static_cast<int>(std::ceil(height * std::sin(std::min(widest, std::numbers::pi / 2)))));
  const int width = 2 * half_width;
  const double metres_per_pixel = geometry.range_max_m / height;
  cv::Mat column(height, width, CV_32F);
  cv::Mat row(height, width, CV_32F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double x = (height - v - 0.5) * metres_per_pixel;
      const double y = (half_width - u - 0.5) * metres_per_pixel;
      column.at<float>(v, u) = column_of(geometry.beam_azimuth_rad, std::atan2(y, x));
      row.at<float>(v, u) = static_cast<float>((std::hypot(x, y) - geometry.range_min_m) / geometry.bin_size_m() - 0.5);
    }
  }
  const cv::Mat polar(image.rows(), image.columns(), CV_8U, const_cast<std::uint8_t*>(image.pixels().data()));
  Image2<std::uint8_t> fan(height, width);
  cv::Mat view(height, width, CV_8U, fan.pixels().data());
  cv::remap(polar, view, column, row, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return fan;
}

}  // namespace ensonify
