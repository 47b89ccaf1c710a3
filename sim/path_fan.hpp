#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "ensonify/sim/ray_fan.hpp"

namespace ensonify {

/// Where the paths of multipath leave and enter: the fan of a sonar in `columns` equal shares of its beams, each in
/// `rows` strata of elevation of equal weight (four fifths by the one-way pattern, the rest uniform: a quiet flank holds
/// few points). In every stratum one direction, at a place that never changes: the same pose sees the same multipath.
///
/// A tile is 8 neighbouring columns by one row; its directions are stratified in both angles (a (0,3,2)-net, digitally
/// shifted for every tile).
class PathFan {
 public:
  /// `density`: 1, or how many times as many pairs of points (whole power of 64 asks for whole multiples).
  PathFan(const SonarModel& sonar, int density);

  static constexpr int tile_columns = 8;

  struct Direction {
    Eigen::Vector3f unit;  ///< sonar frame
    float choice, along;   ///< numbers in 0..1 for the walk that begins here
    float turn_cosine, turn_sine;
  };

  /// What the instrument is in a direction: one-way power pattern (transmitting or receiving), and the fan's points per
  /// steradian.
  struct Place {
    int column = -1;  ///< -1 outside of the fan
    float gain = 0;
    float points_per_sr = 0;
    float width_rad = 0;   ///< of a tile, in azimuth
    float height_rad = 0;  ///< of a row
  };

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const Direction& direction(int column, int row) const {
    return directions_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  }
  Place place_of(const Eigen::Vector3f& unit) const;

 private:
  struct Elevation {
    float gain, density;  ///< one-way pattern; share of the rows per radian
  };

  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> edges_rad_;          ///< of the columns, descending
  std::vector<float> azimuth_gain_;       ///< of the columns, one way
  std::vector<float> column_at_azimuth_;  ///< equidistant from edges_rad_.front() down
  float half_arc_sine_ = 0;
  std::vector<Elevation> elevation_;  ///< equidistant in sine
  std::vector<Direction> directions_;
};

}  // namespace ensonify
