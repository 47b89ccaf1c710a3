#pragma once

#include <vector>

#include "ensonify/core/echo.hpp"
#include "ensonify/sim/ray_column.hpp"

namespace ensonify {

/// Range bins of a window in single precision, as the inner loops use them.
struct RangeBins {
  float start_m;
  float bins_per_m;
  int count;

  float place_of(float range_m) const { return (range_m - start_m) * bins_per_m; }
};

/// Adds the energy of every ray of a shaded column to `energy` (count bins), spread over its footprint.
void add_energy(const RayColumn& rays, const RangeBins& bins, float* energy);

/// The same, and adds energy times elevation to `moment`; within a footprint the elevation goes from border to border.
void add_energy_at_elevation(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins, float* energy,
                             float* moment);

/// Finds the first bin before which at least half of a beam's nominal elevation arc is occluded.
class ShadowCount {
 public:
  explicit ShadowCount(int bins) : hits_in_bin_(static_cast<std::size_t>(bins), 0) {}

  void clear();
  void add(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins);
  int start_bin() const;

 private:
  std::vector<int> hits_in_bin_;
  int hits_before_window_ = 0;
  int rays_ = 0;
};

/// The images of a PingTruth that say what echoes in each cell.
class CellTruth {
 public:
  CellTruth(int bins, int beams, PingTruth& truth);
  void add(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins, const RayScene& scene, int beam);

 private:
  PingTruth* truth_;
  Image2<float> strongest_;
};

}  // namespace ensonify
