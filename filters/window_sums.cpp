#include "ensonify/filters/window_sums.hpp"

#include <algorithm>
#include <cstdlib>

namespace ensonify {

int mirrored(int i, int n) {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  const int folded = std::abs(i) % period;
  return std::min(folded, period - folded);
}

Image2<float> mirrored_border(const Image2<float>& image, int radius) {
  Image2<float> wide(image.rows() + 2 * radius, image.columns() + 2 * radius);
  for (int i = 0; i < wide.rows(); ++i) {
    const auto from = image.row(mirrored(i - radius, image.rows()));
    const auto to = wide.row(i);
    std::copy(from.begin(), from.end(), to.begin() + radius);
    for (int j = 0; j < radius; ++j) {
      to[j] = from[mirrored(j - radius, image.columns())];
      to[radius + image.columns() + j] = from[mirrored(image.columns() + j, image.columns())];
    }
  }
  return wide;
}

WindowSums::WindowSums(const Image2<float>& image, int radius, WindowBorder border)
    : image_(image), radius_(radius), window_(2 * radius + 1), border_(border), from_(window_) {
  const std::size_t columns = image.columns();
  for (Sums& sums : from_) sums = {Row(columns), Row(columns)};
  until_ = {Row(columns), Row(columns)};
  run_.resize(columns + 2 * radius);
  longer_.resize(run_.size());
  columns_.resize(columns);
  squares_.resize(columns);
}

void WindowSums::add_row(int row, Sums& sums) const {
  const bool inside = row >= 0 && row < image_.rows();
  if (!inside && border_ == WindowBorder::zero) return;
  const auto pixels = image_.row(mirrored(row, image_.rows()));
  for (std::size_t j = 0; j < pixels.size(); ++j) {
    const double x = pixels[j];
    sums.values[j] += x;
    sums.squares[j] += x * x;
  }
}

/// The window of output row i covers rows i - radius .. i + radius: the rest of a block of `window` rows that begins at
/// a multiple of it (counted from -radius), and the start of the next.
void WindowSums::start_block() {
  const auto clear = [](Sums& sums) {
    std::ranges::fill(sums.values, 0.0);
    std::ranges::fill(sums.squares, 0.0);
  };
  clear(from_.back());
  for (int k = window_ - 1; k >= 0; --k) {
    if (k < window_ - 1) from_[k] = from_[k + 1];
    add_row(row_ - radius_ + k, from_[k]);
  }
  clear(until_);
}

/// Sums of 1, 2, 4, ... neighbours, of which the window takes those that its size has bits for: whole vectors at a
/// time, and hardly more work for a large window.
void WindowSums::across(const Row& columns, std::span<double> out) {
  const int n = static_cast<int>(columns.size());
  std::ranges::copy(columns, run_.begin() + radius_);
  for (int j = 0; j < radius_; ++j) {
    const bool zero = border_ == WindowBorder::zero;
    run_[j] = zero ? 0.0 : columns[mirrored(j - radius_, n)];
    run_[radius_ + n + j] = zero ? 0.0 : columns[mirrored(n + j, n)];
  }
  std::copy_n(run_.begin(), n, out.begin());  // the window is odd
  int covered = 1;
  for (int length = 1; 2 * length <= window_; length *= 2) {
    const int doubled = static_cast<int>(run_.size()) - length;
    for (int j = 0; j < doubled; ++j) longer_[j] = run_[j] + run_[j + length];
    run_.swap(longer_);
    if ((window_ & (2 * length)) == 0) continue;
    for (int j = 0; j < n; ++j) out[j] += run_[j + covered];
    covered += 2 * length;
  }
}

void WindowSums::next_row(std::span<double> mean, std::span<double> variance) {
  const int k = row_ % window_;
  if (k == 0) {
    start_block();
  } else {
    add_row(row_ + radius_, until_);
  }
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    columns_[j] = from_[k].values[j] + until_.values[j];
    squares_[j] = from_[k].squares[j] + until_.squares[j];
  }
  ++row_;
  across(columns_, mean);
  across(squares_, variance);
  const double share = 1.0 / (static_cast<double>(window_) * window_);
  for (std::size_t j = 0; j < mean.size(); ++j) {
    mean[j] *= share;
    variance[j] = std::max(variance[j] * share - mean[j] * mean[j], 0.0);
  }
}

}  // namespace ensonify
