#include <utility>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/loft.hpp"
#include "ensonify/scenes/shape_request.hpp"

namespace ensonify {
namespace {

Assembly build_box(const ShapeRequest& r) {
  const double x = r.length("length_m"), y = r.length("width_m"), z = r.length("height_m");
  return assembly_of(make_box({x, y, z}));
}

Assembly build_sphere(const ShapeRequest& r) {
  const double radius_m = r.length("radius_m");
  return assembly_of(make_sphere(radius_m, r.field.count_or("detail", 3, 0, 6)));
}

Assembly build_cylinder(const ShapeRequest& r) {
  const double radius_m = r.length("radius_m"), height_m = r.length("height_m");
  return assembly_of(make_cylinder(radius_m, height_m, r.field.count_or("segments", 48, 3, 1024)));
}

Assembly build_cone(const ShapeRequest& r) {
  const double radius_m = r.length("radius_m"), height_m = r.length("height_m");
  const double top_radius_m = r.field.number_or("top_radius_m", 0, {0, length_limits_m.high});
  return assembly_of(make_cone(radius_m, top_radius_m, height_m, r.field.count_or("segments", 48, 3, 1024)));
}

Assembly build_plane(const ShapeRequest& r) {
  const double x = r.length("length_m"), y = r.length("width_m");
  return assembly_of(make_plane(x, y));
}

Assembly build_torus(const ShapeRequest& r) {
  const double ring_m = r.length("major_radius_m"), tube_m = r.length("tube_radius_m");
  if (tube_m >= ring_m) r.field.reader.fail("tube_radius_m", "must be below major_radius_m");
  const int segments = r.field.count_or("segments", 64, 3, 1024);
  return assembly_of(make_torus(ring_m, tube_m, segments, r.field.count_or("tube_segments", 24, 3, 256)));
}

constexpr std::size_t max_profile_points = 1000;

Polygon read_profile(Reader& reader, std::size_t fewest) {
  Polygon profile;
  for (const auto& p : read_points(reader, "profile", 2, fewest, max_profile_points, "a pair of coordinates"))
    profile.emplace_back(p[0], p[1]);
  return profile;
}

void refuse_crossing(const Reader& reader, const Polygon& outline) {
  if (!is_simple(outline))
    reader.fail("profile", "crosses, touches or repeats itself; its edges may meet at corners only");
}

Assembly build_extrusion(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  const Polygon profile = read_profile(reader, 3);
  refuse_crossing(reader, profile);
  const double height_m = r.length("height_m");
  const std::string axis = r.choice_or_first("axis", {"z", "x", "y"});
  TriangleMesh mesh = extrude(profile, -0.5 * height_m, 0.5 * height_m);
  for (Eigen::Vector3f& v : mesh.vertices_m) {
    if (axis == "x") v = Eigen::Vector3f(v.z(), v.x(), v.y());
    if (axis == "y") v = Eigen::Vector3f(v.x(), -v.z(), v.y());
  }
  return assembly_of(std::move(mesh));
}

Assembly build_lathe(const ShapeRequest& r) {
  Reader& reader = r.field.reader;
  const bool ring = reader.boolean_or("ring", false);
  const Polygon profile = read_profile(reader, ring ? 3 : 2);
  const int segments = r.field.count_or("segments", 48, 3, 1024);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const bool may_touch = !ring && (i == 0 || i + 1 == profile.size());
    if (profile[i].x() < 0 || (profile[i].x() == 0 && !may_touch)) {
      reader.fail("profile", ring ? "a ring's radii are all above 0" : "radii are above 0, but at the ends 0 or above");
    }
  }
  Polygon outline = profile;
  if (!ring && outline.front().x() > 0) outline.insert(outline.begin(), {0, profile.front().y()});
  if (!ring && outline.back().x() > 0) outline.emplace_back(0, profile.back().y());
  refuse_crossing(reader, outline);
  r.check_triangles("segments", 2.0 * static_cast<double>(outline.size()) * segments);
  return assembly_of(ring ? turn_ring_profile(profile, segments) : turn_profile(profile, segments));
}

}  // namespace

ShapeTable solid_shapes() {
  return {{"box", build_box},     {"sphere", build_sphere}, {"cylinder", build_cylinder},   {"cone", build_cone},
          {"plane", build_plane}, {"torus", build_torus},   {"extrusion", build_extrusion}, {"lathe", build_lathe}};
}

}  // namespace ensonify
