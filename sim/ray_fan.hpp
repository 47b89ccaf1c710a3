#pragma once

#include <vector>

#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// The rays of one ping in the sonar frame: a grid of elevation x azimuth. Every beam cell is split into
/// `rays_per_beam` equal columns; elevations are the centres of equal steps over where the two-way pattern exceeds
/// -40 dB, which reaches beyond the nominal field of view: what lies outside is attenuated, not absent.
///
/// Density, where the instrument does not set it: columns at most half a beam width apart, rows at most three range
/// bins of arc apart at the far end of the window, in multiples of 8.
struct RayFan {
  struct Column {
    float azimuth_rad = 0;
    float cos_azimuth = 1;
    float sin_azimuth = 0;
    float width_rad = 0;
    float gain = 1;  ///< two-way fan pattern at this azimuth
  };

  explicit RayFan(const SonarModel& sonar);

  int rays_per_beam = 1;
  std::vector<Column> columns;  ///< beams * rays_per_beam, port-most first

  int elevation_rays = 0;
  std::vector<float> elevation_rad;  ///< ascending
  std::vector<float> cos_elevation, sin_elevation;
  std::vector<float> cos_edge, sin_edge;  ///< elevation_rays + 1 borders
  std::vector<float> row_gain;            ///< two-way pattern * solid angle per radian of azimuth

  int first_nominal_row = 0;  ///< rows within the nominal elevation field of view: [first, last)
  int last_nominal_row = 0;
};

}  // namespace ensonify
