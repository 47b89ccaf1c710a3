#include "ensonify/scenes/scene_shapes.hpp"

#include <fmt/format.h>

#include "ensonify/scenes/shape_request.hpp"

namespace ensonify {
namespace {

const ShapeTable& builders() {
  static const ShapeTable table = [] {
    ShapeTable all;
    for (const auto& family : {solid_shapes, line_shapes, ground_shapes, structure_shapes, vessel_shapes})
      all.merge(family());
    return all;
  }();
  return table;
}

}  // namespace

void ShapeRequest::check_triangles(std::string_view name, double triangles) const {
  constexpr double most = 1e6;
  if (triangles > most) {
    field.reader.fail(name, fmt::format("gives {:.3g} triangles, more than {:.3g}", triangles, most));
  }
}

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& [name, builder] : builders()) result.push_back(name);
    return result;
  }();
  return names;
}

Assembly build_shape(const std::string& shape, const FieldSampler& field, RandomKey key, const ScatterGround& ground) {
  return builders().at(shape)(ShapeRequest{field, key.child("shape"), ground});
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
