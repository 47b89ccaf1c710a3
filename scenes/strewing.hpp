#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {

/// Ground height (m) and the path to keep clear, both in the object frame.
struct ScatterGround {
  std::function<double(double x_m, double y_m)> height_m;
  std::vector<Vec3> path_m;
};

/// Distance (m) of a point from a polyline; infinite for an empty one.
double distance_to_path_m(const Vec3& p, const std::vector<Vec3>& path_m);

/// Any orientation, all alike.
Eigen::Quaterniond random_rotation(RandomSequence& random);

/// Where things may be strewn.
struct StrewnArea {
  Eigen::AlignedBox2d area_m;
  bool overlap = false;           ///< false: a thing finds a place of its own, or none after 40 tries
  double path_clearance_m = 0.8;  ///< free water to keep about the path
};

/// Finds places on the ground for one thing after another.
class Strewer {
 public:
  Strewer(const StrewnArea& area, const ScatterGround& ground) : area_(area), ground_(ground) {}

  /// Centre of a thing that no other may come closer to than the sum of their radii, `lift_m` above the ground, with
  /// all within `reach_m` clear of the path.
  std::optional<Vec3> place(RandomSequence& random, double radius_m, double reach_m, double lift_m);

 private:
  struct Placed {
    Vec3 centre_m;
    double radius_m;
  };
  StrewnArea area_;
  const ScatterGround& ground_;
  std::vector<Placed> placed_;
};

}  // namespace ensonify
