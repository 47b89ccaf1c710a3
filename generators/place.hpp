#pragma once

#include <string>

#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

/// A scene in one layout, ready for pings, with its ground truth.
struct Place {
  Scene scene;
  RayScene rays;
  OccupancyGrid truth;
};

Place make_place(const std::string& scene, std::uint64_t layout, const std::string& isa);

/// True where the ball of radius_m about p_world touches no occupied cell and lies within the grid.
bool has_room(const OccupancyGrid& truth, const Vec3& p_world, double radius_m);

}  // namespace ensonify
