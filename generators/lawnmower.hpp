#pragma once

#include "ensonify/generators/smoothed_way.hpp"
#include "ensonify/generators/trajectory_spec.hpp"

namespace ensonify {

/// A straight piece of a survey, world x and y (m).
struct Lane {
  Eigen::Vector2d from_m, to_m;
};

/// Parallel lanes over the rectangle, in the order and direction they are swum: alternating, the first along
/// `heading_deg`. No point of the rectangle is further than half of spacing_m from a lane's line; neighbours are evenly
/// apart, at most spacing_m. Throws ConfigError above 10 000 lanes.
std::vector<Lane> survey_lanes(const Lawnmower& mow, const Eigen::AlignedBox2d& area_m);

/// The lanes, joined by turns that look where the vehicle goes; at the end it turns about, over pi rounding_m / speed
/// on the spot, and swims all back, looking ahead.
SmoothedWay survey_way(const Lawnmower& mow, const Eigen::AlignedBox2d& area_m, double rounding_m);

}  // namespace ensonify
