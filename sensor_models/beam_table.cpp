#include "ensonify/sensor_models/beam_table.hpp"

#include <cmath>
#include <cstddef>

namespace ensonify {
namespace {

/// From +1 to -1 in `count` equal steps; 0 for a single beam.
double symmetric_step(int beam, int count) { return count > 1 ? 1.0 - 2.0 * beam / (count - 1) : 0.0; }

}  // namespace

std::vector<double> uniform_angle_beams(int count, double fov_rad) {
  std::vector<double> azimuth(static_cast<std::size_t>(count));
  for (int b = 0; b < count; ++b) azimuth[b] = 0.5 * fov_rad * symmetric_step(b, count);
  return azimuth;
}

std::vector<double> uniform_sine_beams(int count, double fov_rad) {
  std::vector<double> azimuth(static_cast<std::size_t>(count));
  const double edge = std::sin(0.5 * fov_rad);
  for (int b = 0; b < count; ++b) azimuth[b] = std::asin(edge * symmetric_step(b, count));
  return azimuth;
}

BeamGap widest_gap(const std::vector<double>& azimuth_rad, double width_rad) {
  BeamGap widest;
  for (std::size_t b = 1; b < azimuth_rad.size(); ++b) {
    const double gap = (std::sin(azimuth_rad[b - 1]) - std::sin(azimuth_rad[b])) / (2.0 * std::sin(0.5 * width_rad));
    if (gap > widest.widths) widest = {static_cast<int>(b) - 1, gap};
  }
  return widest;
}

}  // namespace ensonify
