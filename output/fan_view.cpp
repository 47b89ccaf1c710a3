#include "ensonify/output/fan_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "ensonify/core/error.hpp"

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

/// Where things lie in a view of that height.
struct FanLayout {
  int height, half_width;
  double metres_per_pixel;

  FanLayout(const SonarGeometry& geometry, int height_px) : height(height_px) {
    const double widest =
        std::max(std::abs(geometry.beam_azimuth_rad.front()), std::abs(geometry.beam_azimuth_rad.back()));
    half_width = std::max(1, static_cast<int>(std::ceil(height * std::sin(std::min(widest, std::numbers::pi / 2)))));
    metres_per_pixel = geometry.range_max_m / height;
  }
};

template <typename Pixel>
cv::Mat mat_of(const Image2<Pixel>& image) {
  return {image.rows(), image.columns(), cv::DataType<Pixel>::type, const_cast<Pixel*>(image.pixels().data())};
}

template <typename Pixel>
Image2<Pixel> drawn(const Image2<Pixel>& image, const SonarGeometry& geometry, int height, int interpolation) {
  const FanLayout layout(geometry, height);
  const int width = 2 * layout.half_width;
  cv::Mat column(height, width, CV_32F);
  cv::Mat row(height, width, CV_32F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double x = (height - v - 0.5) * layout.metres_per_pixel;
      const double y = (layout.half_width - u - 0.5) * layout.metres_per_pixel;
      column.at<float>(v, u) = column_of(geometry.beam_azimuth_rad, std::atan2(y, x));
      row.at<float>(v, u) = static_cast<float>((std::hypot(x, y) - geometry.range_min_m) / geometry.bin_size_m() - 0.5);
    }
  }
  Image2<Pixel> fan(height, width);
  cv::Mat view = mat_of(fan);
  cv::remap(mat_of(image), view, column, row, interpolation, cv::BORDER_CONSTANT, cv::Scalar(0));
  return fan;
}

}  // namespace

Image2<std::uint8_t> fan_view(const Image2<std::uint8_t>& image, const SonarGeometry& geometry, int height) {
  return drawn(image, geometry, height, cv::INTER_LINEAR);
}

Image2<float> fan_view(const Image2<float>& image, const SonarGeometry& geometry, int height, Resampling resampling) {
  return drawn(image, geometry, height, resampling == Resampling::nearest ? cv::INTER_NEAREST : cv::INTER_LINEAR);
}

Image2<float> polar_view(const Image2<float>& fan, const SonarGeometry& geometry) {
  const FanLayout layout(geometry, fan.rows());
  if (fan.empty() || fan.columns() != 2 * layout.half_width) {
    throw DataError(
        fmt::format("is {} x {} pixels; a fan of +-{:.4g} deg that is {} pixels high is {} wide, the sonar at "
                    "the middle of its lower edge",
                    fan.rows(), fan.columns(), std::abs(geometry.beam_azimuth_rad.front()) * 180.0 / std::numbers::pi,
                    fan.rows(), 2 * layout.half_width));
  }
  cv::Mat column(geometry.range_bins, geometry.beams(), CV_32F);
  cv::Mat row(geometry.range_bins, geometry.beams(), CV_32F);
  for (int k = 0; k < geometry.range_bins; ++k) {
    for (int b = 0; b < geometry.beams(); ++b) {
      const double range_px = geometry.bin_centre_m(k) / layout.metres_per_pixel;
      const double theta = geometry.beam_azimuth_rad[static_cast<std::size_t>(b)];
      column.at<float>(k, b) = static_cast<float>(layout.half_width - range_px * std::sin(theta) - 0.5);
      row.at<float>(k, b) = static_cast<float>(fan.rows() - range_px * std::cos(theta) - 0.5);
    }
  }
  Image2<float> polar(geometry.range_bins, geometry.beams());
  cv::Mat view = mat_of(polar);
  cv::remap(mat_of(fan), view, column, row, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return polar;
}

}  // namespace ensonify
