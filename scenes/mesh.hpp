#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ensonify {

/// Triangles with shared vertices, metres, in the frame of the object. Counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace ensonify
