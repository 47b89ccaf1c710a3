#include "ensonify/scenes/basic_shapes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "ensonify/scenes/loft.hpp"

namespace ensonify {
namespace {

using Index = std::uint32_t;

Eigen::Vector3f vertex(double x, double y, double z) { return Vec3(x, y, z).cast<float>(); }

TriangleMesh make_icosahedron() {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  for (const Vec3& v :
       {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g),
        Vec3(0, 1, -g), Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)}) {
    mesh.vertices_m.push_back(v.normalized().cast<float>());
  }
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

TriangleMesh subdivide_on_unit_sphere(const TriangleMesh& mesh) {
  TriangleMesh finer{mesh.vertices_m, {}};
  std::map<std::pair<Index, Index>, Index> midpoints;
  const auto midpoint = [&](Index a, Index b) {
    const auto [entry, is_new] = midpoints.try_emplace(std::minmax(a, b), static_cast<Index>(finer.vertices_m.size()));
    if (is_new) {
      const Vec3 middle = mesh.vertices_m[a].cast<double>() + mesh.vertices_m[b].cast<double>();
      finer.vertices_m.push_back(middle.normalized().cast<float>());
    }
    return entry->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
    finer.triangles.insert(finer.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace

TriangleMesh make_box(const Vec3& size_m) {
  const Vec3 h = 0.5 * size_m;
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices_m.push_back(
        vertex(corner & 1 ? h.x() : -h.x(), corner & 2 ? h.y() : -h.y(), corner & 4 ? h.z() : -h.z()));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh make_sphere(double radius_m, int detail) {
  TriangleMesh mesh = make_icosahedron();
  for (int level = 0; level < detail; ++level) mesh = subdivide_on_unit_sphere(mesh);
  for (Eigen::Vector3f& v : mesh.vertices_m) v = (radius_m * v.cast<double>()).cast<float>();
  return mesh;
}

TriangleMesh make_cylinder(double radius_m, double height_m, int segments) {
  return make_cone(radius_m, radius_m, height_m, segments);
}

TriangleMesh make_cone(double radius_m, double top_radius_m, double height_m, int segments) {
  const bool pointed = top_radius_m <= 0;
  const Index n = static_cast<Index>(segments);
  const double h = 0.5 * height_m;
  TriangleMesh mesh;
  mesh.vertices_m = {vertex(0, 0, -h), vertex(0, 0, h)};
  const auto add_ring = [&](double radius, double z) {
    for (Index i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / n;
      mesh.vertices_m.push_back(vertex(radius * std::cos(angle), radius * std::sin(angle), z));
    }
  };
  add_ring(radius_m, -h);
  if (!pointed) add_ring(top_radius_m, h);

  constexpr Index bottom_centre = 0, top_centre = 1, ring = 2;
  for (Index i = 0; i < n; ++i) {
    const Index here = ring + i, next = ring + (i + 1) % n;
    mesh.triangles.push_back({bottom_centre, next, here});
    if (pointed) {
      mesh.triangles.push_back({here, next, top_centre});
    } else {
      mesh.triangles.push_back({here, next, next + n});
      mesh.triangles.push_back({here, next + n, here + n});
      mesh.triangles.push_back({here + n, next + n, top_centre});
    }
  }
  return mesh;
}

TriangleMesh make_torus(double ring_radius_m, double tube_radius_m, int segments, int tube_segments) {
  Polygon circle;
  for (int i = 0; i < tube_segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / tube_segments;
    circle.emplace_back(ring_radius_m + tube_radius_m * std::cos(angle), tube_radius_m * std::sin(angle));
  }
  return turn_ring_profile(circle, segments);
}

TriangleMesh make_plane(double length_m, double width_m) {
  const double x = 0.5 * length_m, y = 0.5 * width_m;
  return {{vertex(-x, -y, 0), vertex(x, -y, 0), vertex(x, y, 0), vertex(-x, y, 0)}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh make_hull(double length_m, double beam_m, double draft_m, double freeboard_m) {
  constexpr Index stations = 17;  // cross sections from the transom to the stem
  constexpr Index points = 13;    // from the port deck edge round the keel to the starboard deck edge
  TriangleMesh mesh;
  for (Index s = 0; s < stations; ++s) {
    const double along = static_cast<double>(s) / (stations - 1);
    const double fullness = std::sqrt(1.0 - std::pow(along, 3.0) * 0.98) * (0.85 + 0.15 * std::min(1.0, 4.0 * along));
    const double keel_m = -draft_m * (1.0 - 0.8 * std::pow(along, 4.0));
    const double rake_m = 0.12 * length_m * std::pow(along, 2.0);  // the stem leans forward above the keel
    for (Index p = 0; p < points; ++p) {
      const double around = std::numbers::pi * p / (points - 1);
      const double down = std::pow(std::sin(around), 0.8);
      const double z = p == 0 || p == points - 1 ? freeboard_m : freeboard_m + down * (keel_m - freeboard_m);
      const double side = std::cos(around) < 0 ? -1.0 : 1.0;
      const double y = p == points / 2 ? 0.0 : side * std::pow(std::abs(std::cos(around)), 0.6) * fullness;
      mesh.vertices_m.push_back(
          vertex(length_m * (along - 0.5) * 0.88 - 0.06 * length_m + rake_m * (1.0 - down), 0.5 * beam_m * y, z));
    }
  }
  const auto at = [](Index station, Index point) { return station * points + point; };
  for (Index s = 0; s + 1 < stations; ++s) {
    for (Index p = 0; p < points; ++p) {
      const Index q = (p + 1) % points;  // the last strip closes over the deck
      mesh.triangles.push_back({at(s, p), at(s + 1, q), at(s, q)});
      mesh.triangles.push_back({at(s, p), at(s + 1, p), at(s + 1, q)});
    }
  }
  for (Index p = 1; p + 1 < points; ++p) {
    mesh.triangles.push_back({at(0, 0), at(0, p), at(0, p + 1)});
    mesh.triangles.push_back({at(stations - 1, 0), at(stations - 1, p + 1), at(stations - 1, p)});
  }
  return mesh;
}

}  // namespace ensonify
