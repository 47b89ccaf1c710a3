#include "ensonify/scenes/mesh_weld.hpp"

#include <Eigen/Geometry>
#include <bit>
#include <unordered_map>
#include <vector>

namespace ensonify {
namespace {

using Bits = std::array<std::uint32_t, 3>;

struct BitsHash {
  std::size_t operator()(const Bits& b) const {
    std::uint64_t hash = b[0];
    for (const std::uint32_t word : {b[1], b[2]}) hash = (hash ^ (hash >> 29) ^ word) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

Bits bits_of(const Eigen::Vector3f& v) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x == 0.0f ? 0.0f : x); };  // -0 is 0
  return {bits(v.x()), bits(v.y()), bits(v.z())};
}

bool in_reach(const Eigen::Vector3f& v) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= weld_reach_m; }

bool has_area(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d ab = (b - a).cast<double>(), ac = (c - a).cast<double>();
  return ab.cross(ac).squaredNorm() > 0;
}

}  // namespace

Welded weld(const TriangleMesh& mesh) {
  Welded result;
  std::unordered_map<Bits, std::uint32_t, BitsHash> index_of;
  const auto welded_index = [&](const Eigen::Vector3f& v) {
    const auto [entry, is_new] =
        index_of.try_emplace(bits_of(v), static_cast<std::uint32_t>(result.mesh.vertices_m.size()));
    if (is_new) result.mesh.vertices_m.push_back(v);
    return entry->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &pa = mesh.vertices_m[a], &pb = mesh.vertices_m[b], &pc = mesh.vertices_m[c];
    if (!in_reach(pa) || !in_reach(pb) || !in_reach(pc)) {
      ++result.out_of_reach;
      continue;
    }
    if (!has_area(pa, pb, pc)) {
      ++result.flat;
      continue;
    }
    const std::uint32_t ia = welded_index(pa), ib = welded_index(pb), ic = welded_index(pc);
    result.mesh.triangles.push_back({ia, ib, ic});
  }
  return result;
}

}  // namespace ensonify
