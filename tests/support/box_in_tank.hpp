#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/scene.hpp"
#include "support/meshes.hpp"

/// A wooden box in the bundled `test_tank`, and three poses that see it.
namespace ensonify::test {

inline void add_box(Scene& tank) {
  tank.materials.push_back({"wood", -20.0, -12.8, 25.0, "bundled table"});
  tank.meshes.push_back(box_mesh({1.2F, 2.3F, -2.2F}, {1.8F, 2.9F, -1.3F}));
  Instance box;
  box.name = "box";
  box.mesh = static_cast<int>(tank.meshes.size()) - 1;
  box.material = static_cast<int>(tank.materials.size()) - 1;
  tank.instances.push_back(box);
}

/// With all that stands in the tank.
inline Scene tank_with_box() {
  Scene tank = load_scene("test_tank");
  add_box(tank);
  return tank;
}

/// Between the tank's four walls alone, of glass: mirrors.
inline Scene box_between_mirrors() {
  Scene tank = load_scene("test_tank");
  std::erase_if(tank.instances, [](const Instance& i) { return i.name.rfind("wall_", 0) != 0; });
  const auto glass =
      std::find_if(tank.materials.begin(), tank.materials.end(), [](const Material& m) { return m.name == "glass"; });
  Material wall{"mirror", -35.0, 14.6, 1100.0, "glass of the bundled table"};
  if (glass != tank.materials.end()) wall = *glass;
  tank.materials.push_back(wall);
  for (Instance& instance : tank.instances) instance.material = static_cast<int>(tank.materials.size()) - 1;
  add_box(tank);
  return tank;
}

inline std::vector<Pose> poses_at_box() {
  return {pose_from_xyz_rpy({-1.5, 2.2, -1.7}, 0, 0.02, 0.35), pose_from_xyz_rpy({-2.0, 2.4, -1.75}, 0, 0, 0.3),
          pose_from_xyz_rpy({2.4, -1.0, -1.7}, 0, 0, 1.31)};
}

}  // namespace ensonify::test
