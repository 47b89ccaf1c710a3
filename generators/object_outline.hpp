#pragma once

#include <string>
#include <vector>

#include "ensonify/generators/smoothed_way.hpp"
#include "ensonify/generators/trajectory_spec.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify {

/// Box of all instances of an object: of that name, or with numbers behind it (copies, parts). Throws ConfigError, with
/// the nearest name, where there is none.
Eigen::AlignedBox3d object_box_m(const Scene& scene, const std::string& object);

/// Convex hull (counter-clockwise, world x and y) of what the object's triangles have between two heights.
/// Throws ConfigError where that is nothing.
std::vector<Eigen::Vector2d> object_outline_m(const Scene& scene, const std::string& object, double low_m,
                                              double high_m);

/// A way along the object as `WallFollow` says: along flat sides at exactly standoff_m, round corners on arcs, which
/// the smoothing (at most half of standoff_m) cuts by at most 2 %. Round and round where nothing is left out, else the
/// longest part, there and back. The section is that from 0.25 m below to 0.25 m above depth_m. In the hollows of an
/// object that is not convex, the distance is larger. Throws ConfigError where no part lies in the navigable box.
SmoothedWay wall_way(const WallFollow& wall, const Scene& scene, double rounding_m);

}  // namespace ensonify
