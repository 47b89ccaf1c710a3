#pragma once

#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Two-way loss across the fan, as a factor of power: quadratic in azimuth, 1 ahead, fan_edge_db less at the outer
/// border of the outermost beams' cells.
class FanPattern {
 public:
  explicit FanPattern(const SonarModel& sonar);
  double operator()(double azimuth_rad) const;

 private:
  double edge_rad_, edge_db_;
};

}  // namespace ensonify
