#include "ensonify/evaluation/image_scores.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "ensonify/filters/mat_view.hpp"

namespace ensonify {
namespace {

constexpr double full_scale = 255.0;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

cv::Mat doubles(const Image2<float>& image) {
  cv::Mat mat;
  mat_view(image).convertTo(mat, CV_64F);
  return mat;
}

/// (m / s)^2 of image / clean in a tile; empty where the clean twin is too dark to divide by.
std::optional<double> looks_of_tile(const Image2<float>& image, const Image2<float>& clean, int row, int column,
                                    int side) {
  constexpr float least_level = 20.0F;
  double sum = 0, squares = 0;
  for (int r = row; r < row + side; ++r) {
    for (int c = column; c < column + side; ++c) {
      if (clean(r, c) < least_level) return {};
      const double ratio = static_cast<double>(image(r, c)) / clean(r, c);
      sum += ratio;
      squares += ratio * ratio;
    }
  }
  const double n = static_cast<double>(side) * side, mean = sum / n;
  return mean * mean / std::max(squares / n - mean * mean, 1e-9);
}

}  // namespace

double psnr_db(const Image2<float>& image, const Image2<float>& clean) {
  double squares = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double difference = static_cast<double>(image.pixels()[i]) - clean.pixels()[i];
    squares += difference * difference;
  }
  return 10.0 * std::log10(full_scale * full_scale / (squares / static_cast<double>(image.size())));
}

double ssim(const Image2<float>& image, const Image2<float>& clean) {
  constexpr int window = 11, border = window / 2;
  constexpr double sigma = 1.5, c1 = 0.01 * full_scale * 0.01 * full_scale, c2 = 0.03 * full_scale * 0.03 * full_scale;
  if (std::min(image.rows(), image.columns()) < window) return nothing;
  const auto blurred = [&](const cv::Mat& mat) {
    cv::Mat out;
    cv::GaussianBlur(mat, out, {window, window}, sigma);
    return out;
  };
  const cv::Mat x = doubles(image), y = doubles(clean);
  const cv::Mat mx = blurred(x), my = blurred(y), xx = blurred(x.mul(x)), yy = blurred(y.mul(y)),
                xy = blurred(x.mul(y));
  double sum = 0;
  for (int r = border; r < x.rows - border; ++r) {
    for (int c = border; c < x.cols - border; ++c) {
      const double a = mx.at<double>(r, c), b = my.at<double>(r, c);
      const double variances = xx.at<double>(r, c) - a * a + yy.at<double>(r, c) - b * b;
      const double covariance = xy.at<double>(r, c) - a * b;
      sum += (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variances + c2));
    }
  }
  return sum / (static_cast<double>(x.rows - 2 * border) * (x.cols - 2 * border));
}

double edge_preservation(const Image2<float>& image, const Image2<float>& clean) {
  cv::Mat a, b;
  cv::Laplacian(mat_view(image), a, CV_32F);
  cv::Laplacian(mat_view(clean), b, CV_32F);
  a -= cv::mean(a);
  b -= cv::mean(b);
  const double energy = a.dot(a) * b.dot(b);
  return energy > 0.0 ? a.dot(b) / std::sqrt(energy) : nothing;
}

double equivalent_looks(const Image2<float>& image, const Image2<float>& clean) {
  constexpr int side = 16;
  std::vector<double> looks;
  for (int r = 0; r + side <= clean.rows(); r += side) {
    for (int c = 0; c + side <= clean.columns(); c += side) {
      if (const auto of_tile = looks_of_tile(image, clean, r, c, side)) looks.push_back(*of_tile);
    }
  }
  if (looks.empty()) return nothing;
  const auto middle = looks.begin() + static_cast<std::ptrdiff_t>(looks.size() / 2);
  std::nth_element(looks.begin(), middle, looks.end());
  return *middle;
}

}  // namespace ensonify
