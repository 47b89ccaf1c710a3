#include "ensonify/scenes/scene_shapes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/heightfield.hpp"
#include "ensonify/scenes/pile_row.hpp"
#include "ensonify/scenes/rubble_mound.hpp"

namespace ensonify {
namespace {

constexpr Limits length_limits_m{1e-3, 1e4};
constexpr Limits unit_interval{0, 1};

struct Request {
  const FieldSampler& field;
  RandomKey key;
  const ScatterGround& ground;

  double length(std::string_view name) const { return field.number(name, length_limits_m); }
  double length_or(std::string_view name, double fallback) const {
    return field.number_or(name, fallback, length_limits_m);
  }
};

Assembly build_box(const Request& r) {
  const double x = r.length("length_m"), y = r.length("width_m"), z = r.length("height_m");
  return assembly_of(make_box({x, y, z}));
}

Assembly build_sphere(const Request& r) {
  const double radius_m = r.length("radius_m");
  return assembly_of(make_sphere(radius_m, r.field.count_or("detail", 3, 0, 6)));
}

Assembly build_cylinder(const Request& r) {
  const double radius_m = r.length("radius_m"), height_m = r.length("height_m");
  return assembly_of(make_cylinder(radius_m, height_m, r.field.count_or("segments", 48, 3, 1024)));
}

Assembly build_cone(const Request& r) {
  const double radius_m = r.length("radius_m"), height_m = r.length("height_m");
  const double top_radius_m = r.field.number_or("top_radius_m", 0, {0, length_limits_m.high});
  return assembly_of(make_cone(radius_m, top_radius_m, height_m, r.field.count_or("segments", 48, 3, 1024)));
}

Assembly build_plane(const Request& r) {
  const double x = r.length("length_m"), y = r.length("width_m");
  return assembly_of(make_plane(x, y));
}

Assembly build_hull(const Request& r) {
  const double length_m = r.length("length_m"), beam_m = r.length("beam_m");
  const double draft_m = r.length("draft_m"), freeboard_m = r.length_or("freeboard_m", 0.6);
  return assembly_of(make_hull(length_m, beam_m, draft_m, freeboard_m));
}

Assembly build_boulder(const Request& r) {
  const double radius_m = r.length("radius_m");
  const double roughness = r.field.number_or("roughness", 0.25, unit_interval);
  const double flatness = r.field.number_or("flatness", 0.35, {0, 0.8});
  return assembly_of(make_boulder(radius_m, roughness, flatness, r.field.count_or("detail", 3, 0, 6), r.key));
}

Assembly build_heightfield(const std::string& shape, const Request& r) {
  const double length_m = r.length("length_m"), width_m = r.length("width_m");
  const double spacing_m = r.field.number_or("spacing_m", 0.1, {1e-3, 100});
  const double thickness_m = r.length_or("thickness_m", 0.5);
  check_grid_size(r.field.reader, {length_m, width_m}, spacing_m);
  const Terrain terrain = read_terrain(shape, r.field, spacing_m);
  const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
  return assembly_of(slab_mesh(sample_terrain(terrain, r.key, {-half, half}, spacing_m), thickness_m));
}

Assembly build_pile_row(const Request& r) {
  PileRow row;
  Reader& reader = r.field.reader;
  row.piles = r.field.count("piles", 1, 1000);
  row.spacing_m = r.length("spacing_m");
  row.length_m = r.length("length_m");
  row.radius_m = read_distribution(reader, "radius_m", length_limits_m);
  row.tilt_deg = read_distribution_or(reader, "tilt_deg", 0, {-45, 45});
  row.offset_m = read_distribution_or(reader, "offset_m", 0, {-100, 100});
  return build_pile_row(row, r.key);
}

BoulderScatter read_rocks(const Request& r, std::string_view count_key) {
  BoulderScatter scatter;
  scatter.boulders = r.field.count(count_key, 0, 5000);
  scatter.radius_m = read_distribution(r.field.reader, "radius_m", {1e-2, 100});
  scatter.roughness = r.field.number_or("roughness", scatter.roughness, unit_interval);
  scatter.flatness = r.field.number_or("flatness", scatter.flatness, {0, 0.8});
  scatter.burial = r.field.number_or("burial", scatter.burial, unit_interval);
  scatter.variants = r.field.count_or("variants", scatter.variants, 1, 64);
  scatter.detail = r.field.count_or("detail", scatter.detail, 0, 5);
  scatter.path_clearance_m = r.field.number_or("path_clearance_m", scatter.path_clearance_m, not_negative);
  return scatter;
}

Assembly build_boulder_scatter(const Request& r) {
  BoulderScatter scatter = read_rocks(r, "boulders");
  Reader& reader = r.field.reader;
  const std::vector<double> a = reader.numbers("area_m", 4, {-1e4, 1e4});
  if (a[0] >= a[2] || a[1] >= a[3]) reader.fail("area_m", "must be [x_min, y_min, x_max, y_max]");
  scatter.area_m = Eigen::AlignedBox2d(Eigen::Vector2d(a[0], a[1]), Eigen::Vector2d(a[2], a[3]));
  scatter.overlap = reader.boolean_or("overlap", false);
  return scatter_boulders(scatter, r.ground, r.key);
}

Assembly build_rubble(const Request& r) {
  RubbleMound mound;
  mound.length_m = r.length("length_m");
  mound.crest_width_m = r.length("crest_width_m");
  mound.height_m = r.length("height_m");
  mound.slope_rad = r.field.angle_or("slope_deg", 34, {5, 80});
  mound.one_sided = r.field.reader.boolean_or("one_sided", false);
  mound.rocks = read_rocks(r, "rocks");
  return build_rubble_mound(mound, r.ground, r.key);
}

using Builder = std::function<Assembly(const Request&)>;

const std::map<std::string, Builder>& builders() {
  static const std::map<std::string, Builder> table{
      {"box", build_box},
      {"sphere", build_sphere},
      {"cylinder", build_cylinder},
      {"cone", build_cone},
      {"plane", build_plane},
      {"hull", build_hull},
      {"boulder", build_boulder},
      {"fractal", [](const Request& r) { return build_heightfield("fractal", r); }},
      {"rippled", [](const Request& r) { return build_heightfield("rippled", r); }},
      {"pile_row", [](const Request& r) { return build_pile_row(r); }},
      {"boulder_scatter", build_boulder_scatter},
      {"rubble_mound", build_rubble}};
  return table;
}

}  // namespace

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& [name, builder] : builders()) result.push_back(name);
    return result;
  }();
  return names;
}

Assembly build_shape(const std::string& shape, const FieldSampler& field, RandomKey key, const ScatterGround& ground) {
  return builders().at(shape)(Request{field, key.child("shape"), ground});
}

Terrain read_terrain(const std::string& shape, const FieldSampler& field, double spacing_m) {
  Terrain terrain;
  if (shape == "flat") return terrain;
  const bool rippled = shape == "rippled";
  terrain.fractal_rms_m = field.number_or("roughness_m", rippled ? 0.0 : 0.1, {0, 100});
  terrain.fractal_wavelength_m = field.number_or("wavelength_m", 5, length_limits_m);
  terrain.fractal_finest_m = 2 * spacing_m;
  terrain.hurst = field.number_or("hurst", 0.9, unit_interval);
  if (rippled) {
    terrain.ripple_height_m = field.number("ripple_height_m", {0, 10});
    terrain.ripple_length_m = field.number("ripple_length_m", length_limits_m);
    terrain.ripple_direction_rad = field.angle_or("ripple_direction_deg", 0, {-360, 360});
  }
  return terrain;
}

void check_grid_size(const Reader& reader, const Eigen::Vector2d& size_m, double spacing_m) {
  constexpr double max_nodes = 2e6;
  const double nodes = (size_m.x() / spacing_m + 2) * (size_m.y() / spacing_m + 2);
  if (nodes > max_nodes) {
    reader.fail("spacing_m", fmt::format("gives {:.3g} grid nodes, more than {:.3g}; widen it", nodes, max_nodes));
  }
}

}  // namespace ensonify
