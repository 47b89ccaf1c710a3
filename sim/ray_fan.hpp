#pragma once

#include <array>
#include <vector>

#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// The rays of one ping in the sonar frame. Every beam cell is split into `rays_per_beam` equal columns of azimuth,
/// each column into equal steps of elevation over where the two-way pattern exceeds -60 dB, which reaches beyond the
/// nominal field of view: what lies outside is attenuated, not absent.
///
/// Four neighbouring columns place their rays at four different heights within a step, so that the edge of an object,
/// seen through a beam's point spread, is sampled four times as finely as one column does.
///
/// Density, where the instrument does not set it: columns at most half a beam width apart, rows at most three
/// range bins of arc apart at the far end of the window, in multiples of 8.
struct RayFan {
  /// Elevations of one column.
  struct Rows {
    std::vector<float> elevation_rad;           ///< ascending, equal steps
    std::vector<float> cosine, sine;            ///< of them
    std::vector<float> edge_cosine, edge_sine;  ///< of the borders between, one more
    std::vector<float> gain;                    ///< two-way pattern * solid angle per radian of azimuth
    std::vector<float> gain_slope;              ///< change of the two-way pattern over a step, upwards, over its mean
    int first_nominal = 0;                      ///< rows within the nominal field of view: [first, last)
    int last_nominal = 0;
  };

  struct Column {
    float azimuth_rad = 0;
    float cosine = 1;
    float sine = 0;
    float width_rad = 0;
    float gain = 1;  ///< two-way fan pattern at this azimuth
  };

  explicit RayFan(const SonarModel& sonar);

  static constexpr int stagger = 4;
  const Rows& rows_of(int column) const { return rows[static_cast<std::size_t>(column % stagger)]; }

  int rays_per_beam = 1;
  std::vector<Column> columns;  ///< beams * rays_per_beam, port-most first
  int elevation_rays = 0;
  std::array<Rows, stagger> rows;
};

}  // namespace ensonify
