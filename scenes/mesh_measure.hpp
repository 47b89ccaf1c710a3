#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// Box of all vertices (m); empty for an empty mesh.
Eigen::AlignedBox3d bounding_box_m(const TriangleMesh& mesh);
/// The same after `T`.
Eigen::AlignedBox3d bounding_box_m(const TriangleMesh& mesh, const Eigen::Affine3d& T);

/// Enclosed volume (m^3) by the divergence theorem; positive where triangles turn outward. Meaningful if closed.
double enclosed_volume_m3(const TriangleMesh& mesh);

/// Directed edges that have no single opposite partner; 0 for a watertight, consistently turned mesh.
std::size_t unpaired_edges(const TriangleMesh& mesh);

}  // namespace ensonify
