#include "ensonify/sensor_models/fan_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ensonify {

FanPattern::FanPattern(const SonarModel& sonar) : edge_rad_(0), edge_db_(sonar.fan_edge_db) {
  const std::vector<double> edges = sonar.geometry.beam_edges_rad();
  edge_rad_ = std::max(std::abs(edges.front()), std::abs(edges.back()));
}

double FanPattern::operator()(double azimuth_rad) const {
  const double off_axis = edge_rad_ > 0.0 ? azimuth_rad / edge_rad_ : 0.0;
  return std::pow(10.0, -0.1 * edge_db_ * off_axis * off_axis);
}

}  // namespace ensonify
