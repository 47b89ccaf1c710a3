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

}  // namespace ensonify
