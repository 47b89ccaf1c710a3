#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ensonify/scenes/debris.hpp"
#include "ensonify/scenes/heightfield.hpp"
#include "ensonify/scenes/rubble_mound.hpp"
#include "ensonify/scenes/scene_shapes.hpp"
#include "ensonify/scenes/shape_request.hpp"

namespace ensonify {
namespace {

Assembly build_boulder(const ShapeRequest& r) {
  const double radius_m = r.length("radius_m");
  const double roughness = r.field.number_or("roughness", 0.25, unit_interval);
  const double flatness = r.field.number_or("flatness", 0.35, {0, 0.8});
  return assembly_of(make_boulder(radius_m, roughness, flatness, r.field.count_or("detail", 3, 0, 6), r.key));
}

Assembly build_heightfield(const std::string& shape, const ShapeRequest& r) {
  const double length_m = r.length("length_m"), width_m = r.length("width_m");
  const double spacing_m = r.field.number_or("spacing_m", 0.1, {1e-3, 100});
  const double thickness_m = r.length_or("thickness_m", 0.5);
  check_grid_size(r.field.reader, {length_m, width_m}, spacing_m);
  const Terrain terrain = read_terrain(shape, r.field, spacing_m);
  const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
  return assembly_of(slab_mesh(sample_terrain(terrain, r.key, {-half, half}, spacing_m), thickness_m));
}

Assembly build_fractal(const ShapeRequest& r) { return build_heightfield("fractal", r); }

Assembly build_rippled(const ShapeRequest& r) { return build_heightfield("rippled", r); }

BoulderScatter read_rocks(const ShapeRequest& r, std::string_view count_key) {
  BoulderScatter scatter;
  scatter.boulders = r.field.count(count_key, 0, 5000);
  scatter.radius_m = read_distribution(r.field.reader, "radius_m", {1e-2, 100});
  scatter.roughness = r.field.number_or("roughness", scatter.roughness, unit_interval);
  scatter.flatness = r.field.number_or("flatness", scatter.flatness, {0, 0.8});
  scatter.burial = r.field.number_or("burial", scatter.burial, unit_interval);
  scatter.variants = r.field.count_or("variants", scatter.variants, 1, 64);
  scatter.detail = r.field.count_or("detail", scatter.detail, 0, 5);
  scatter.where.path_clearance_m = r.field.number_or("path_clearance_m", scatter.where.path_clearance_m, not_negative);
  return scatter;
}

void read_area(const ShapeRequest& r, StrewnArea& where) {
  Reader& reader = r.field.reader;
  const std::vector<double> a = reader.numbers("area_m", 4, {-1e4, 1e4});
  if (a[0] >= a[2] || a[1] >= a[3]) reader.fail("area_m", "must be [x_min, y_min, x_max, y_max]");
  where.area_m = Eigen::AlignedBox2d(Eigen::Vector2d(a[0], a[1]), Eigen::Vector2d(a[2], a[3]));
  where.overlap = reader.boolean_or("overlap", false);
}

Assembly build_boulder_scatter(const ShapeRequest& r) {
  BoulderScatter scatter = read_rocks(r, "boulders");
  read_area(r, scatter.where);
  return scatter_boulders(scatter, r.ground, r.key);
}

std::vector<DebrisKind> read_debris_kinds(Reader& reader) {
  const std::vector<std::string> names{"box", "plank", "tube", "tyre", "slab", "boulder"};
  std::vector<DebrisKind> kinds;
  for (const std::string& name : reader.has("kinds") ? reader.texts("kinds") : names) {
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) reader.fail("kinds", fmt::format("'{}' is none of {}", name, fmt::join(names, ", ")));
    kinds.push_back(static_cast<DebrisKind>(known - names.begin()));
  }
  if (kinds.empty()) reader.fail("kinds", "must name one at least");
  return kinds;
}

Assembly build_debris_scatter(const ShapeRequest& r) {
  DebrisScatter scatter;
  Reader& reader = r.field.reader;
  scatter.pieces = r.field.count("pieces", 0, 5000);
  read_area(r, scatter.where);
  scatter.where.path_clearance_m = r.field.number_or("path_clearance_m", scatter.where.path_clearance_m, not_negative);
  scatter.kinds = read_debris_kinds(reader);
  if (reader.has("size_m")) scatter.size_m = read_distribution(reader, "size_m", {1e-2, 100});
  scatter.burial = r.field.number_or("burial", scatter.burial, unit_interval);
  scatter.tilt_rad = r.field.angle_or("tilt_deg", 12, {0, 90});
  return scatter_debris(scatter, r.ground, r.key);
}

Assembly build_rubble(const ShapeRequest& r) {
  RubbleMound mound;
  mound.length_m = r.length("length_m");
  mound.crest_width_m = r.length("crest_width_m");
  mound.height_m = r.length("height_m");
  mound.slope_rad = r.field.angle_or("slope_deg", 34, {5, 80});
  mound.one_sided = r.field.reader.boolean_or("one_sided", false);
  mound.rocks = read_rocks(r, "rocks");
  return build_rubble_mound(mound, r.ground, r.key);
}

}  // namespace

ShapeTable ground_shapes() {
  return {{"boulder", build_boulder},
          {"fractal", build_fractal},
          {"rippled", build_rippled},
          {"boulder_scatter", build_boulder_scatter},
          {"debris_scatter", build_debris_scatter},
          {"rubble_mound", build_rubble}};
}

}  // namespace ensonify
