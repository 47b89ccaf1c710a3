#include "ensonify/scenes/basic_shapes.hpp"
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

}  // namespace

ShapeTable solid_shapes() {
  return {{"box", build_box},
          {"sphere", build_sphere},
          {"cylinder", build_cylinder},
          {"cone", build_cone},
          {"plane", build_plane}};
}

}  // namespace ensonify
