#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "ensonify/config/library.hpp"
#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/material.hpp"
#include "ensonify/scenes/mesh.hpp"
#include "ensonify/scenes/water.hpp"

namespace ensonify {

/// A mesh put into the world. Many instances may share one mesh.
struct Instance {
  std::string name;
  int mesh = 0;                                                  ///< index into Scene::meshes
  int material = 0;                                              ///< index into Scene::materials
  Eigen::Affine3d T_world_object = Eigen::Affine3d::Identity();  ///< rotation, translation, scale
  bool obstacle = true;  ///< false: echoes, but is no occupied space (the water surface)
};

/// A place: what the rays meet. Frame: ENU, metres, z = 0 at the mean water surface.
struct Scene {
  std::string name;
  std::string title;
  std::uint64_t layout = 0;
  Water water;
  std::vector<TriangleMesh> meshes;
  std::vector<Material> materials;
  std::vector<Instance> instances;
  Eigen::AlignedBox3d bounds_m;     ///< the part of the world that the occupancy truth covers; top at most z = 0
  Eigen::AlignedBox3d navigable_m;  ///< where a vehicle may be; inside bounds_m
  double grid_resolution_m = 0.1;
  std::vector<Pose> waypoints;                    ///< the place's default trajectory, T_world_sonar; may be empty
  std::vector<std::filesystem::path> mesh_files;  ///< that it was read from
  std::vector<std::string> warnings;              ///< what loading found odd, e.g. a mesh that looks like millimetres
};

/// Loads a scene YAML in the layout given. Same file and layout: same bits.
/// Throws ConfigError (the YAML breaks a rule) or DataError (a mesh file can not be read).
Scene load_scene(const ConfigSource& source, std::uint64_t layout = 0);

/// A scene YAML, or a mesh file by itself (a path with any other extension than .yaml and .yml).
Scene open_scene(const ConfigSource& source, std::uint64_t layout = 0);

/// The mesh files that a scene YAML names, in its order, without reading them. Throws ConfigError.
std::vector<std::filesystem::path> scene_mesh_files(const std::string& path_or_name);

/// A scene of one mesh file in its own frame, deep under the surface of default sea water, bounds one tenth wider.
Scene scene_from_mesh(const std::filesystem::path& mesh);

}  // namespace ensonify
