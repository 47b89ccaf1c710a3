#include "ensonify/generators/speckle_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "ensonify/generators/distribution_summary.hpp"

namespace ensonify {
namespace {

/// Place i of a row of n that is mirrored at its ends again and again, its last pixel repeated.
int mirrored(int i, int n) {
  const int period = 2 * n;
  const int at = ((i % period) + period) % period;
  return at < n ? at : period - 1 - at;
}

Image2<double> transposed(const Image2<double>& image) {
  Image2<double> result(image.columns(), image.rows());
  for (int r = 0; r < image.rows(); ++r) {
    for (int c = 0; c < image.columns(); ++c) result(c, r) = image(r, c);
  }
  return result;
}

/// Means over speckle_window along each row.
Image2<double> row_means(const Image2<double>& image) {
  constexpr int half = speckle_window / 2;
  const int n = image.columns();
  Image2<double> means(image.rows(), n);
  for (int r = 0; r < image.rows(); ++r) {
    const auto row = image.row(r);
    for (int c = 0; c < n; ++c) {
      double sum = 0;
      if (c >= half && c + half < n) {
        sum = std::accumulate(row.begin() + (c - half), row.begin() + (c + half + 1), 0.0);
      } else {
        for (int i = c - half; i <= c + half; ++i) sum += row[static_cast<std::size_t>(mirrored(i, n))];
      }
      means(r, c) = sum / speckle_window;
    }
  }
  return means;
}

double mean_of(const Image2<double>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0) / static_cast<double>(image.size());
}

std::vector<double*> numbers(SpeckleFigures& f) {
  std::vector<double*> all{
      &f.mean_level,           &f.zero_share,           &f.saturated_share,     &f.contrast,
      &f.fits.weibull_shape,   &f.fits.weibull_scale,   &f.fits.gamma_shape,    &f.fits.gamma_scale,
      &f.fits.lognormal_sigma, &f.fits.lognormal_scale, &f.fits.nakagami_shape, &f.fits.nakagami_scale,
      &f.fits.k_shape,         &f.fits.ks.rayleigh,     &f.fits.ks.exponential, &f.fits.ks.weibull,
      &f.fits.ks.gamma,        &f.fits.ks.lognormal,    &f.fits.ks.nakagami,    &f.fits.ks.k,
      &f.moment_ratio};
  for (double& v : f.range) all.push_back(&v);
  for (double& v : f.beam) all.push_back(&v);
  return all;
}

}  // namespace

Image2<double> normalised_speckle(const GreyImage& image, const Region& region, RandomKey key) {
  Image2<double> values(region.rows(), region.columns());
  const auto columns = static_cast<std::uint64_t>(image.grey.columns());
  for (int r = 0; r < region.rows(); ++r) {
    for (int c = 0; c < region.columns(); ++c) {
      const int row = region.row0 + r, column = region.column0 + c;
      const auto place = static_cast<std::uint64_t>(row) * columns + static_cast<std::uint64_t>(column);
      const double jitter = uniform_at(key, place) - 0.5;
      values(r, c) = std::max(1e-3, image.grey(row, column) / level_step(image.depth) + jitter);
    }
  }
  const Image2<double> means = transposed(row_means(transposed(row_means(values))));
  for (std::size_t i = 0; i < values.size(); ++i) values.pixels()[i] /= means.pixels()[i];
  return values;
}

std::vector<double> drawn_values(const Image2<double>& normalised, RandomKey key) {
  std::vector<double> values(normalised.pixels().begin(), normalised.pixels().end());
  const std::size_t count = std::min(values.size(), static_cast<std::size_t>(most_fitted));
  if (count < values.size()) {
    RandomSequence random(key);
    for (std::size_t i = 0; i < count; ++i) {
      const int other = random.below(static_cast<int>(values.size() - i));
      std::swap(values[i], values[i + static_cast<std::size_t>(other)]);
    }
    values.resize(count);
  }
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(count);
  for (double& v : values) v /= mean;
  return values;
}

Autocorrelation beam_autocorrelation(const Image2<double>& image) {
  const double mean = mean_of(image);
  double variance = 0;
  for (const double v : image.pixels()) variance += (v - mean) * (v - mean);
  variance /= static_cast<double>(image.size());
  Autocorrelation result{};
  result[0] = 1;
  for (int lag = 1; lag <= most_lag && lag < image.columns() && variance > 0; ++lag) {
    double sum = 0;
    for (int r = 0; r < image.rows(); ++r) {
      for (int c = lag; c < image.columns(); ++c) sum += (image(r, c) - mean) * (image(r, c - lag) - mean);
    }
    const double pairs = static_cast<double>(image.rows()) * (image.columns() - lag);
    result[static_cast<std::size_t>(lag)] = sum / pairs / variance;
  }
  return result;
}

Autocorrelation range_autocorrelation(const Image2<double>& image) { return beam_autocorrelation(transposed(image)); }

double correlation(const Image2<double>& a, const Image2<double>& b) {
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  double product = 0, square_a = 0, square_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = a.pixels()[i] - mean_a, y = b.pixels()[i] - mean_b;
    product += x * y;
    square_a += x * x;
    square_b += y * y;
  }
  const double scale = std::sqrt(square_a * square_b);
  return scale > 0 ? product / scale : 0;
}

SpeckleFigures median_figures(std::vector<SpeckleFigures> regions) {
  SpeckleFigures medians;
  const auto slots = numbers(medians);
  std::vector<std::vector<double>> values(slots.size());
  for (SpeckleFigures& region : regions) {
    const auto of_region = numbers(region);
    for (std::size_t i = 0; i < slots.size(); ++i) values[i].push_back(*of_region[i]);
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    std::sort(values[i].begin(), values[i].end());
    *slots[i] = percentile(values[i], 50);
  }
  return medians;
}

SpeckleFigures speckle_figures(const GreyImage& image, const Region& region, RandomKey key) {
  SpeckleFigures f;
  for (int r = region.row0; r < region.row1; ++r) {
    for (const float level : image.grey.row(r).subspan(region.column0, region.columns())) {
      f.mean_level += level;
      f.zero_share += level == 0 ? 1 : 0;
      f.saturated_share += level >= saturated_level ? 1 : 0;
    }
  }
  const double pixels = static_cast<double>(region.rows()) * region.columns();
  for (double* sum : {&f.mean_level, &f.zero_share, &f.saturated_share}) *sum /= pixels;

  const Image2<double> normalised = normalised_speckle(image, region, key.child("jitter"));
  f.range = range_autocorrelation(normalised);
  f.beam = beam_autocorrelation(normalised);
  const std::vector<double> values = drawn_values(normalised, key.child("draw"));
  f.fits = fit_amplitudes(values);
  double square = 0, intensity = 0, intensity_square = 0;
  for (const double x : values) {
    const double i = std::pow(x, f.fits.weibull_shape);
    square += (x - 1) * (x - 1);
    intensity += i;
    intensity_square += i * i;
  }
  const auto n = static_cast<double>(values.size());
  f.contrast = std::sqrt(square / n);
  f.moment_ratio = n * intensity_square / (intensity * intensity);
  return f;
}

}  // namespace ensonify
