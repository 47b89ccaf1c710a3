#include "ensonify/filters/pyradar_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace ensonify {
namespace {

struct Span {
  int begin = 0, end = 0;
};

/// Of the `window` rows (or columns) from i - window / 2 those that are there: an even window even where it should be
/// odd.
Span even_window(int i, int n, int window) {
  const int offset = window / 2;
  return {std::max(i - offset, 0), i + offset < n ? i + offset : n};
}

/// Frost's never reaches the last row and column.
Span frost_window(int i, int n, int window) {
  const int offset = window / 2;
  return {std::max(i - offset, 0), i + offset < n ? i + offset : n - 1};
}

struct Statistics {
  double mean = 0, deviation = 0;
};

Statistics statistics(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

/// In numpy's order: results that are whole but for rounding are cut to 8 bits afterwards.
double numpy_sum(std::span<const double> v) {
  if (v.size() > 128) {
    const std::size_t half = v.size() / 2 - v.size() / 2 % 8;
    return numpy_sum(v.first(half)) + numpy_sum(v.subspan(half));
  }
  std::size_t i = 0;
  double sum = 0;
  if (v.size() >= 8) {
    std::array<double, 8> r{};
    for (; i + 8 <= v.size(); i += 8) {
      for (std::size_t k = 0; k < 8; ++k) r[k] += v[i + k];
    }
    sum = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
  }
  for (; i < v.size(); ++i) sum += v[i];
  return sum;
}

/// Calls pixel_of(window's pixels row by row, its rows, its columns, centre) for every pixel.
template <typename WindowOf, typename PixelOf>
Image2<float> over_windows(const Image2<float>& grey, int window, const WindowOf& window_of, const PixelOf& pixel_of) {
  Image2<float> out(grey.rows(), grey.columns());
  std::vector<double> values;
  for (int i = 0; i < grey.rows(); ++i) {
    const Span rows = window_of(i, grey.rows(), window);
    for (int j = 0; j < grey.columns(); ++j) {
      const Span columns = window_of(j, grey.columns(), window);
      values.clear();
      for (int y = rows.begin; y < rows.end; ++y) {
        const auto row = grey.row(y);
        values.insert(values.end(), row.begin() + columns.begin, row.begin() + columns.end);
      }
      out(i, j) = static_cast<float>(
          values.empty() ? grey(i, j)
                         : pixel_of(values, rows.end - rows.begin, columns.end - columns.begin, grey(i, j)));
    }
  }
  return out;
}

}  // namespace

Image2<float> pyradar_lee(const Image2<float>& grey, int window, double cu, double factor) {
  return over_windows(grey, window, even_window, [=](const std::vector<double>& values, int, int, double pixel) {
    const auto [mean, deviation] = statistics(values);
    if (mean == 0) return 0.0;
    const double c = deviation / mean;
    const double c2 = c == 0 ? 0.01 : c * c;
    const double weight = cu > c ? 0.0 : (1.0 - cu * cu / c2) * factor;
    return std::nearbyint(pixel * weight + mean * (1.0 - weight));
  });
}

Image2<float> pyradar_lee_enhanced(const Image2<float>& grey, const LeeEnhanced& f) {
  return over_windows(grey, f.window.pixels, even_window,
                      [&](const std::vector<double>& values, int, int, double pixel) {
                        const auto [mean, deviation] = statistics(values);
                        const double c = mean == 0 ? 0.0 : deviation / mean;
                        double weight = 0.0;
                        if (c <= f.cu) {
                          weight = 1.0;
                        } else if (c < f.cmax) {
                          weight = std::exp(-f.k * (c - f.cu) / (f.cmax - c));
                        }
                        return std::nearbyint(mean * weight + pixel * (1.0 - weight));
                      });
}

Image2<float> pyradar_frost(const GreyImage& image, const Frost& f) {
  std::vector<double> weights, weighted;
  const auto pixel_of = [&](const std::vector<double>& values, int rows, int columns, double) {
    const auto [mean, deviation] = statistics(values);
    if (mean == 0) return 0.0;
    const double c = deviation == 0 ? 0.01 : deviation / mean;
    const double a = f.damping * c / mean;
    const double centre = values[static_cast<std::size_t>(rows / 2) * columns + columns / 2];
    weights.clear();
    weighted.clear();
    for (const double v : values) {
      weights.push_back(std::exp(-a * std::abs(v - centre)));
      weighted.push_back(weights.back() * v);
    }
    const double result = numpy_sum(weighted) / numpy_sum(weights);
    return image.depth == GreyDepth::bits8 ? std::trunc(result) : result;
  };
  return over_windows(image.grey, f.window.pixels, frost_window, pixel_of);
}

}  // namespace ensonify
