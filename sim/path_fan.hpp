#pragma once

#include <Eigen/Core>
#include <vector>

#include "ensonify/sim/ray_fan.hpp"

namespace ensonify {

/// The directions in which paths of multipath may leave and enter, as a unit square: u is the share of the beams to
/// port, v the share of elevation below, by weight (four fifths the one-way pattern, the rest uniform: points are rare
/// in a quiet flank). Energy is collected in `columns` equal shares of u.
class PathFan {
 public:
  /// `fan`: the sonar's.
  PathFan(const SonarModel& sonar, const RayFan& fan, int columns);

  /// What the instrument is in a direction. One-way power pattern, transmitting or receiving alike.
  struct Place {
    int column = -1;  ///< -1 outside of the fan
    float u = 0;
    float v = 0;
    float gain = 0;
    float azimuth_rad = 0;    ///< of the whole of u, at its rate here
    float elevation_rad = 0;  ///< of the whole of v, at its rate here
  };

  int columns() const { return columns_; }
  /// Unit vector, sonar frame.
  Eigen::Vector3f direction(float u, float v) const;
  Place place_of(const Eigen::Vector3f& unit) const;
  /// How far along a ray (place and unit vector in sonar axes) the last place within the fan may lie. No limit where
  /// the ray may enter or come back.
  float distance_within(const Eigen::Vector3f& place, const Eigen::Vector3f& unit) const;

 private:
  struct Elevation {
    float gain, below, density;  ///< one-way pattern; v; dv / dphi
  };

  int columns_ = 0;
  std::vector<float> edges_rad_;          ///< of the columns, descending
  std::vector<float> azimuth_gain_;       ///< of the columns, one way
  std::vector<float> u_at_azimuth_;       ///< equidistant from edges_rad_.front() down
  std::vector<Eigen::Vector3f> borders_;  ///< of the wedge of azimuths, inward; none where it is half a turn or more
  float half_sine_ = 0;
  std::vector<Elevation> elevation_;  ///< equidistant in the sine of elevation
  std::vector<float> sine_at_v_;      ///< equidistant in v
};

}  // namespace ensonify
