#include "ensonify/scenes/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "ensonify/scenes/mesh_weld.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {
namespace {

using Index = std::uint32_t;

constexpr Index no_vertex = 0xffffffff;

std::uint64_t edge_of(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

using Triangle = std::array<Index, 3>;

/// Midpoints of the edges of a mesh that are to be cut: the longest sides of triangles whose sides are all too long.
/// Thin triangles are left for later: halving would make ever more and thinner ones of them.
class Midpoints {
 public:
  Midpoints(TriangleMesh& mesh, double edge_m) : mesh_(mesh), squared_m2_(edge_m * edge_m) {}

  void mark_longest(const Triangle& t) {
    std::pair<double, std::uint64_t> longest{0, 0};  // ties go by the edge, so that neighbours agree
    std::size_t side = 0;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3];
      const std::pair here{(mesh_.vertices_m[b] - mesh_.vertices_m[a]).cast<double>().squaredNorm(), edge_of(a, b)};
      shortest = std::min(shortest, here.first);
      if (here > longest) {
        longest = here;
        side = i;
      }
    }
    const Eigen::Vector3f pa = mesh_.vertices_m[t[side]], pb = mesh_.vertices_m[t[(side + 1) % 3]];
    const Eigen::Vector3f middle = 0.5f * (pa + pb);
    if (shortest <= squared_m2_ || middle == pa || middle == pb) return;  // as fine as asked, or as numbers get
    const auto [entry, is_new] = middles_.try_emplace(longest.second, static_cast<Index>(mesh_.vertices_m.size()));
    if (is_new) mesh_.vertices_m.push_back(middle);
  }

  Index of(Index a, Index b) const {
    const auto entry = middles_.find(edge_of(a, b));
    return entry == middles_.end() ? no_vertex : entry->second;
  }

 private:
  TriangleMesh& mesh_;
  double squared_m2_;
  std::unordered_map<std::uint64_t, Index> middles_;
};

/// Cuts one triangle along the middles of its sides; `middle[i]` lies between corners i and i + 1.
void cut(const TriangleMesh& mesh, const Triangle& t, const std::array<Index, 3>& middle, std::vector<Triangle>& out) {
  const auto count = 3 - std::count(middle.begin(), middle.end(), no_vertex);
  if (count == 0) {
    out.push_back(t);
  } else if (count == 3) {
    out.insert(out.end(), {{t[0], middle[0], middle[2]},
                           {t[1], middle[1], middle[0]},
                           {t[2], middle[2], middle[1]},
                           {middle[0], middle[1], middle[2]}});
  } else if (count == 1) {
    const std::size_t i = static_cast<std::size_t>(
        std::find_if(middle.begin(), middle.end(), [](Index m) { return m != no_vertex; }) - middle.begin());
    const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    out.insert(out.end(), {{a, middle[i], c}, {middle[i], b, c}});
  } else {
    // The side from a to b is whole; of the two diagonals of the quad the shorter.
    const std::size_t i = static_cast<std::size_t>(std::find(middle.begin(), middle.end(), no_vertex) - middle.begin());
    const Index a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    const Index bc = middle[(i + 1) % 3], ca = middle[(i + 2) % 3];
    const auto squared = [&](Index p, Index q) { return (mesh.vertices_m[p] - mesh.vertices_m[q]).squaredNorm(); };
    out.push_back({ca, bc, c});
    if (squared(a, bc) <= squared(b, ca)) {
      out.insert(out.end(), {{a, b, bc}, {a, bc, ca}});
    } else {
      out.insert(out.end(), {{a, b, ca}, {b, bc, ca}});
    }
  }
}

/// Points along edges, evenly spaced, the same for both triangles of an edge.
class EdgePoints {
 public:
  EdgePoints(TriangleMesh& mesh, double edge_m) : mesh_(mesh), edge_m_(edge_m) {}

  /// Vertices from a to b, both included.
  std::vector<Index> between(Index a, Index b) {
    const Index low = std::min(a, b), high = std::max(a, b);
    const Eigen::Vector3f from = mesh_.vertices_m[low], span = mesh_.vertices_m[high] - from;
    constexpr double slack = 1.25;  // rather a little too long than cut in half
    const int pieces = std::max(1, static_cast<int>(std::ceil(span.cast<double>().norm() / (slack * edge_m_))));
    const auto [entry, is_new] = first_.try_emplace(edge_of(a, b), static_cast<Index>(mesh_.vertices_m.size()));
    std::vector<Index> points{low};
    for (int i = 1; i < pieces; ++i) {
      if (is_new) mesh_.vertices_m.push_back(from + static_cast<float>(i) / static_cast<float>(pieces) * span);
      points.push_back(entry->second + static_cast<Index>(i - 1));
    }
    points.push_back(high);
    if (a > b) std::reverse(points.begin(), points.end());
    return points;
  }

 private:
  TriangleMesh& mesh_;
  double edge_m_;
  std::unordered_map<std::uint64_t, Index> first_;
};

/// Cuts a triangle that has one short side across, in a zigzag between its two other sides.
void cut_across(TriangleMesh& mesh, const Triangle& t, EdgePoints& edges, std::vector<Triangle>& out) {
  const auto squared = [&](std::size_t i) {
    return (mesh.vertices_m[t[i]] - mesh.vertices_m[t[(i + 1) % 3]]).cast<double>().squaredNorm();
  };
  std::size_t base = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (squared(i) < squared(base)) base = i;
  }
  const Index a = t[base], b = t[(base + 1) % 3], tip = t[(base + 2) % 3];
  const std::vector<Index> left = edges.between(a, tip), right = edges.between(b, tip);
  const std::size_t n = left.size() - 1, m = right.size() - 1;
  for (std::size_t i = 0, j = 0; i + j < n + m - 1;) {
    if ((i + 1) * m <= (j + 1) * n) {
      out.push_back({left[i], right[j], left[i + 1]});
      ++i;
    } else {
      out.push_back({left[i], right[j], right[j + 1]});
      ++j;
    }
  }
}

/// 0..1: how much grows at a place. About `coverage` of all places are above 0.
double density(RandomKey key, const Vec3& p_m, const Growth& growth) {
  constexpr double rms = 0.203;  // of gradient noise
  const Vec3 off_lattice(0.37, 0.71, 0.53);
  const double patches = gradient_noise(key.child("patches"), p_m / growth.patch_m + off_lattice) / rms;
  const double bumps = gradient_noise(key.child("bumps"), 2.1 * p_m / growth.patch_m + off_lattice) / rms;
  // Even noise from about normal noise: the logistic function is near to its distribution function.
  const double share = 1 / (1 + std::exp(-1.702 * (0.8 * patches + 0.6 * bumps)));
  return std::clamp((share - (1 - growth.coverage)) / growth.coverage, 0.0, 1.0);
}

std::vector<Vec3> outward_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices_m.size(), Vec3::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 pa = mesh.vertices_m[a].cast<double>(), pb = mesh.vertices_m[b].cast<double>();
    const Vec3 normal = (pb - pa).cross(mesh.vertices_m[c].cast<double>() - pa);
    for (const Index corner : {a, b, c}) normals[corner] += normal;
  }
  for (Vec3& normal : normals) normal = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero());
  return normals;
}

}  // namespace

TriangleMesh split_long_edges(const TriangleMesh& mesh, double edge_m, std::size_t most) {
  const auto check = [&](std::size_t triangles) {
    if (triangles > most) {
      throw GrowthTooFine(fmt::format("brings the object beyond {} triangles; enlarge patch_m or shrink the object",
                                      max_grown_triangles));
    }
  };
  TriangleMesh fine = mesh;
  for (bool changed = true; changed;) {
    Midpoints midpoints(fine, edge_m);
    for (const Triangle& t : fine.triangles) midpoints.mark_longest(t);
    std::vector<Triangle> next;
    for (const Triangle& t : fine.triangles) {
      cut(fine, t, {midpoints.of(t[0], t[1]), midpoints.of(t[1], t[2]), midpoints.of(t[2], t[0])}, next);
      check(next.size());
    }
    changed = next.size() != fine.triangles.size();
    fine.triangles = std::move(next);
  }
  EdgePoints edges(fine, edge_m);
  std::vector<Triangle> all;
  for (const Triangle& t : fine.triangles) {
    cut_across(fine, t, edges, all);
    check(all.size());
  }
  fine.triangles = std::move(all);
  return fine;
}

TriangleMesh overgrow(const TriangleMesh& mesh, const Growth& growth, RandomKey key, std::size_t most) {
  // Three vertices a bump at least, else it is lost between them.
  TriangleMesh grown = split_long_edges(weld(mesh).mesh, growth.patch_m / 3, most);
  const std::vector<Vec3> normals = outward_normals(grown);
  for (std::size_t i = 0; i < grown.vertices_m.size(); ++i) {
    const Vec3 p = grown.vertices_m[i].cast<double>();
    grown.vertices_m[i] = (p + growth.thickness_m * density(key, p, growth) * normals[i]).cast<float>();
  }
  return grown;
}

Assembly overgrow(const Assembly& assembly, const Growth& growth, RandomKey key) {
  if (growth.thickness_m <= 0 || growth.coverage <= 0) return assembly;
  Assembly result;
  std::size_t left = max_grown_triangles;
  for (const Part& part : assembly.parts) {
    TriangleMesh placed = assembly.meshes[static_cast<std::size_t>(part.mesh)];
    for (Eigen::Vector3f& v : placed.vertices_m) v = (part.T_object_part * v.cast<double>()).cast<float>();
    TriangleMesh grown = overgrow(placed, growth, key, left);
    left -= grown.triangles.size();
    result.parts.push_back({static_cast<int>(result.meshes.size()), Eigen::Affine3d::Identity()});
    result.meshes.push_back(std::move(grown));
  }
  return result;
}

}  // namespace ensonify
