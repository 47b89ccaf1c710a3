#include "ensonify/scenes/mesh_measure.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace ensonify {

Eigen::AlignedBox3d bounding_box_m(const TriangleMesh& mesh) {
  return bounding_box_m(mesh, Eigen::Affine3d::Identity());
}

Eigen::AlignedBox3d bounding_box_m(const TriangleMesh& mesh, const Eigen::Affine3d& T) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& v : mesh.vertices_m) box.extend(T * v.cast<double>());
  return box;
}

double enclosed_volume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = mesh.vertices_m[a].cast<double>();
    const Eigen::Vector3d pb = mesh.vertices_m[b].cast<double>();
    const Eigen::Vector3d pc = mesh.vertices_m[c].cast<double>();
    six_volumes += pa.dot(pb.cross(pc));
  }
  return six_volumes / 6.0;
}

std::size_t unpaired_edges(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  }
  std::sort(edges.begin(), edges.end());
  std::size_t unpaired = 0;
  for (const auto& [from, to] : edges) {
    const auto same = std::equal_range(edges.begin(), edges.end(), std::pair(from, to));
    const auto opposite = std::equal_range(edges.begin(), edges.end(), std::pair(to, from));
    if (same.second - same.first != 1 || opposite.second - opposite.first != 1) ++unpaired;
  }
  return unpaired;
}

}  // namespace ensonify
