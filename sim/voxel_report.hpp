#pragma once

#include <cstddef>
#include <string>

namespace ensonify {

/// How the inside of an object was told from its outside.
enum class SolidMethod {
  parity,        ///< majority of the crossings along x, y and z
  outside_fill,  ///< what a flood from outside does not reach through the surface
};

/// What was found while one object was voxelised, and how far to trust it.
struct VoxelReport {
  std::string name;
  std::size_t triangles = 0;
  std::size_t open_edges = 0;            ///< of one triangle only
  std::size_t nonmanifold_edges = 0;     ///< of more than two triangles
  std::size_t parity_disagreements = 0;  ///< cells off the surface where the votes of the three axes differ
  std::size_t surface_cells = 0;
  std::size_t interior_cells = 0;
  bool watertight = false;       ///< no edge of an odd number of triangles
  std::size_t unlike_edges = 0;  ///< whose two triangles are turned differently
  bool inside_out = false;       ///< watertight, all triangles turned inwards: taken as turned outwards
  SolidMethod method = SolidMethod::parity;

  /// One line for people, e.g. "hull: 99224 triangles, watertight, solid by parity, 206215 surface + 4098301 interior".
  std::string describe() const;
};

}  // namespace ensonify
