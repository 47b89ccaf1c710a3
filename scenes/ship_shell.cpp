#include "ensonify/scenes/ship_shell.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "ensonify/scenes/mesh_weld.hpp"
#include "ensonify/scenes/polygon.hpp"

namespace ensonify {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Cells that are kept, without those that touch another only by a corner.
std::vector<std::vector<bool>> without_corner_contacts(int stations, int points,
                                                       const std::function<bool(int, int)>& kept) {
  std::vector<std::vector<bool>> keep(static_cast<std::size_t>(stations));
  for (int s = 0; s < stations; ++s) {
    for (int p = 0; p < points; ++p) keep[static_cast<std::size_t>(s)].push_back(kept(s, p));
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t s = 0; s + 1 < keep.size(); ++s) {
      for (std::size_t p = 0; p < keep[s].size(); ++p) {
        const std::size_t q = (p + 1) % keep[s].size();
        const bool a = keep[s][p], b = keep[s][q], c = keep[s + 1][p], d = keep[s + 1][q];
        if (a == d && b == c && a != b) {
          keep[s][p] = keep[s][q] = keep[s + 1][p] = keep[s + 1][q] = false;
          changed = true;
        }
      }
    }
  }
  return keep;
}

}  // namespace

ShipShell::ShipShell(const Ship& ship, int stations)
    : form_(ship),
      section_(form_.section()),
      stations_(stations),
      size_m_(ship.length_m, ship.beam_m, ship.depth_m),
      centre_m_(0, 0, 0.5 * ship.depth_m - ship.draft_m) {
  for (int s = 0; s <= stations; ++s) {
    for (const auto& point : section_) outer_m_.push_back(form_.at(static_cast<double>(s) / stations, point));
  }
}

/// Port and starboard are one at the stem.
std::uint32_t ShipShell::index(int station, int point) const {
  const int shell = form_.shell_points();
  int p = point % points();
  if (station == stations_) p = p < shell ? std::min(p, shell - 1 - p) : 0;
  return static_cast<std::uint32_t>(station * points() + p);
}

bool ShipShell::below_hatch(int point) const {
  const int shell = form_.shell_points();
  return point >= shell && point + 1 < points();
}

Vec3 ShipShell::cell_m(int station, int point) const {
  return 0.25 * (outer_m_[index(station, point)] + outer_m_[index(station, point + 1)] +
                 outer_m_[index(station + 1, point)] + outer_m_[index(station + 1, point + 1)]);
}

Triangles ShipShell::cell(int station, int point) const {
  const std::uint32_t a = index(station, point), b = index(station, point + 1);
  const std::uint32_t c = index(station + 1, point), d = index(station + 1, point + 1);
  Triangles triangles;
  if (c != d) triangles.push_back({a, c, d});
  triangles.push_back({a, d, b});
  return triangles;
}

Triangles ShipShell::transom() const {
  Polygon outline;  // counter-clockwise in y, z, that is with the stem towards the eye
  for (int p = points() - 1; p >= 0; --p) outline.emplace_back(outer_m_[index(0, p)].y(), outer_m_[index(0, p)].z());
  const std::uint32_t last = static_cast<std::uint32_t>(points() - 1);
  Triangles triangles;
  for (const auto& [a, b, c] : triangulate(outline)) triangles.push_back({last - a, last - c, last - b});
  return triangles;
}

TriangleMesh ShipShell::solid() const {
  TriangleMesh mesh;
  for (const Vec3& p : outer_m_) mesh.vertices_m.push_back(p.cast<float>());
  mesh.triangles = transom();
  for (int s = 0; s < stations_; ++s) {
    for (int p = 0; p < points(); ++p) {
      const Triangles two = cell(s, p);
      mesh.triangles.insert(mesh.triangles.end(), two.begin(), two.end());
    }
  }
  return weld(mesh).mesh;
}

TriangleMesh ShipShell::plates(const std::function<bool(int, int)>& kept, bool with_transom, double plate_m) const {
  const auto keep = without_corner_contacts(stations_, points(), kept);
  Triangles outside = with_transom ? transom() : Triangles{};
  for (int s = 0; s < stations_; ++s) {
    for (int p = 0; p < points(); ++p) {
      if (!keep[static_cast<std::size_t>(s)][static_cast<std::size_t>(p)]) continue;
      const Triangles two = cell(s, p);
      outside.insert(outside.end(), two.begin(), two.end());
    }
  }

  // The inside is the outside drawn together towards the middle: inside of it everywhere, for the hull is full enough.
  const Vec3 shrink = Vec3::Ones() - 2 * plate_m * size_m_.cwiseInverse();
  TriangleMesh mesh;
  for (const Vec3& p : outer_m_) mesh.vertices_m.push_back(p.cast<float>());
  for (const Vec3& p : outer_m_) {
    mesh.vertices_m.push_back((centre_m_ + shrink.cwiseProduct(p - centre_m_)).cast<float>());
  }
  const std::uint32_t inner = static_cast<std::uint32_t>(outer_m_.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& [a, b, c] : outside) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({inner + a, inner + c, inner + b});
    edges.insert({{a, b}, {b, c}, {c, a}});
  }
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    mesh.triangles.push_back({b, a, inner + a});
    mesh.triangles.push_back({b, inner + a, inner + b});
  }
  return weld(mesh).mesh;
}

}  // namespace ensonify
