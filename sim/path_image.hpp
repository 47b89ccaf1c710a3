#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/sim/beam_echo.hpp"

namespace ensonify {

/// Collects energy in boxes of range, column by column of a PathFan. Keeps second differences, so that a box costs four
/// additions however long it is; in double, so that their sums leave no trace of the strong in the weak.
class PathImage {
 public:
  PathImage(int columns, const RangeBins& bins)
      : bins_(bins),
        stride_(static_cast<std::size_t>(bins.count) + 2),
        differences_(static_cast<std::size_t>(columns) * stride_, 0.0) {}

  /// Energy spread evenly from centre - extent / 2 to centre + extent / 2, but not nearer than nearest_m, and over a
  /// bin at least. What lies outside of the window is lost.
  void add(int column, float centre_m, float extent_m, float nearest_m, float energy) {
    float near = bins_.place_of(std::max(centre_m - 0.5f * extent_m, nearest_m));
    float far = bins_.place_of(centre_m + 0.5f * extent_m);
    const float lacking = std::max(0.0f, 1.0f - (far - near));
    near -= 0.5f * lacking;
    far += 0.5f * lacking;
    const auto count = static_cast<float>(bins_.count);
    if (!(far > 0.0f && near < count)) return;
    const double density = static_cast<double>(energy) / static_cast<double>(far - near);
    double* at = differences_.data() + static_cast<std::size_t>(column) * stride_;
    step(at, std::max(near, 0.0f), density);
    step(at, std::min(far, count), -density);
  }

  /// False where `add` would lose such a box, wherever its energy arrives.
  bool may_hold(float centre_m, float extent_m) const {
    return bins_.place_of(centre_m - 0.5f * extent_m) - 0.5f < static_cast<float>(bins_.count);
  }

  /// Bins x beams, before absorption.
  Image2<float> over_beams(int columns, int beams) const {
    Image2<float> image(bins_.count, beams);
    constexpr int together = 8;  // columns: whole cache lines of the row-major image are written
    std::vector<Share> shares;
    for (int first = 0; first < columns; first += together) {
      const int count = std::min(together, columns - first);
      std::array<double, together> level{}, least{};
      std::array<const double*, together> from{};
      shares.clear();
      for (int c = 0; c < count; ++c) {
        from[c] = differences_.data() + static_cast<std::size_t>(first + c) * stride_;
        add_shares(first + c, c, columns, beams, shares);
      }
      for (int bin = 0; bin < bins_.count; ++bin) {
        for (int c = 0; c < count; ++c) least[c] = std::max(least[c], level[c] += from[c][bin]);
      }
      for (double& largest : least) largest *= 1e-12;  // below are rounding errors
      level.fill(0.0);
      for (int bin = 0; bin < bins_.count; ++bin) {
        for (int c = 0; c < count; ++c) level[c] += from[c][bin];
        float* out = image.row(bin).data();
        for (const Share& s : shares) {
          if (level[s.column] > least[s.column]) out[s.beam] += static_cast<float>(s.share * level[s.column]);
        }
      }
    }
    return image;
  }

 private:
  /// Of a column's energy, what a beam gets.
  struct Share {
    int beam;
    int column;  ///< of those that are read together
    double share;
  };

  static void add_shares(int column, int name, int columns, int beams, std::vector<Share>& shares) {
    // Beams that a column covers, a beam being 1 long.
    const double first = static_cast<double>(column) * beams / columns;
    const double last = static_cast<double>(column + 1) * beams / columns;
    for (int beam = static_cast<int>(first); beam < beams && beam < last; ++beam) {
      shares.push_back({beam, name, (std::min(last, beam + 1.0) - std::max(first, 1.0 * beam)) / (last - first)});
    }
  }

  static void step(double* at, float place, double density) {
    const int bin = static_cast<int>(place);
    const double within = static_cast<double>(place - static_cast<float>(bin));
    at[bin] += density * (1.0 - within);
    at[bin + 1] += density * within;
  }

  RangeBins bins_;
  std::size_t stride_;
  std::vector<double> differences_;
};

}  // namespace ensonify
