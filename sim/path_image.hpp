#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/sim/beam_echo.hpp"

namespace ensonify {

/// Energy that is spread evenly over ranges, as second differences: `density` begins in near_bin, of which `near_next`
/// in the bin after it, and ends likewise.
struct PathBox {
  int near_bin, far_bin;
  float density, near_next, far_next;
};

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
  PathBox box(float centre_m, float extent_m, float nearest_m, float energy) const {
    const auto last = static_cast<float>(bins_.count);
    const float from_m = centre_m - 0.5f * extent_m;
    const float begin = bins_.place_of(from_m > nearest_m ? from_m : nearest_m);
    const float end = bins_.place_of(centre_m + 0.5f * extent_m);
    const float lacking = end - begin < 1.0f ? 0.5f * (1.0f - (end - begin)) : 0.0f;
    const float density = energy / (end - begin + 2.0f * lacking);
    const float near = within(begin - lacking, last);
    const float far = within(end + lacking, last);
    const int near_bin = static_cast<int>(near);
    const int far_bin = static_cast<int>(far);
    return {near_bin, far_bin, density, density * (near - static_cast<float>(near_bin)),
            density * (far - static_cast<float>(far_bin))};
  }

  void add(int column, const PathBox& box) {
    double* at = differences_.data() + static_cast<std::size_t>(column) * stride_;
    const double density = box.density;
    at[box.near_bin] += density - static_cast<double>(box.near_next);
    at[box.near_bin + 1] += static_cast<double>(box.near_next);
    at[box.far_bin] -= density - static_cast<double>(box.far_next);
    at[box.far_bin + 1] -= static_cast<double>(box.far_next);
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

  static float within(float place, float last) {
    const float above = place > 0.0f ? place : 0.0f;
    return above < last ? above : last;
  }

  RangeBins bins_;
  std::size_t stride_;
  std::vector<double> differences_;
};

}  // namespace ensonify
