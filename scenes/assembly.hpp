#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// One mesh put into an object. Many parts may share a mesh.
struct Part {
  int mesh = 0;  ///< index into Assembly::meshes
  Eigen::Affine3d T_object_part = Eigen::Affine3d::Identity();
};

/// The geometry of one object in its own frame (metres).
struct Assembly {
  std::vector<TriangleMesh> meshes;
  std::vector<Part> parts;
};

inline Assembly assembly_of(TriangleMesh mesh) { return {{std::move(mesh)}, {Part{}}}; }

}  // namespace ensonify
