#include <fmt/format.h>

#include <set>
#include <string>

#include "ensonify/scenes/material_library.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/scenes/scene_objects.hpp"
#include "ensonify/scenes/scene_shapes.hpp"

namespace ensonify {
namespace {

constexpr double max_grid_cells = 64e6;

Water read_water(Reader& file) {
  Water water;
  if (!file.has("water")) return water;
  Reader reader = file.child("water");
  water.temperature_c = reader.number_or("temperature_c", water.temperature_c, {0, 35});
  water.salinity_psu = reader.number_or("salinity_psu", water.salinity_psu, {0, 42});
  water.depth_m = reader.number_or("depth_m", water.depth_m, {0, 1000});
  water.ph = reader.number_or("ph", water.ph, {6, 9});
  reader.finish();
  return water;
}

void read_extent(Reader& file, Scene& scene) {
  scene.bounds_m = read_box(file, "bounds");
  if (scene.bounds_m.max().z() > 0) file.fail("bounds", "its top must not rise above the water, z = 0");
  scene.navigable_m = read_box(file, "navigable");
  if (!scene.bounds_m.contains(scene.navigable_m)) file.fail("navigable", "must lie inside bounds");
  scene.grid_resolution_m = file.number_or("grid_resolution_m", scene.grid_resolution_m, {1e-3, 10});
  const double cells = (scene.bounds_m.sizes() / scene.grid_resolution_m).array().ceil().prod();
  if (cells > max_grid_cells) {
    file.fail(file.has("grid_resolution_m") ? "grid_resolution_m" : "bounds",
              fmt::format("gives {:.3g} M grid cells, more than {:.0f} M; widen it or shrink bounds", cells * 1e-6,
                          max_grid_cells * 1e-6));
  }
}

void take_waypoints(Reader& file, Scene& scene) {
  if (!file.has("waypoints")) return;
  scene.waypoints = read_waypoints(file, "waypoints");
  for (std::size_t i = 0; i < scene.waypoints.size(); ++i) {
    if (!scene.navigable_m.contains(scene.waypoints[i].translation())) {
      file.fail("waypoints", fmt::format("entry {} lies outside navigable", i));
    }
  }
}

Eigen::AlignedBox2d widened(const Eigen::AlignedBox3d& bounds_m, double margin_m) {
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(margin_m);
  return {bounds_m.min().head<2>() - margin, bounds_m.max().head<2>() + margin};
}

void add_seabed(Reader& file, SceneDraft& draft, RandomKey layout_key) {
  if (!file.has("seabed")) return;
  Reader reader = file.child("seabed");
  const RandomKey key = layout_key.child("seabed");
  RandomSequence random(key);
  const FieldSampler field{reader, random};
  const std::string shape = reader.choice("shape", {"flat", "fractal", "rippled"});
  const double depth_m = field.number("depth_m", {0.01, 1e4});
  const double margin_m = field.number_or("margin_m", 5, {0, 1e4});
  const double thickness_m = field.number_or("thickness_m", 0.5, {0.01, 1e3});
  const double slope = std::tan(field.angle_or("slope_deg", 0, {0, 60}));
  const double slope_direction_rad = field.angle_or("slope_direction_deg", 0, {-360, 360});
  const Eigen::AlignedBox2d area_m = widened(draft.scene.bounds_m, margin_m);
  double spacing_m = area_m.sizes().maxCoeff();
  if (shape != "flat") {
    spacing_m = reader.number_or("spacing_m", 0.2, {1e-3, 100});
    check_grid_size(reader, area_m.sizes(), spacing_m);
  }
  Terrain terrain = read_terrain(shape, field, spacing_m);
  terrain.level_m = -depth_m;
  terrain.slope = -slope * Eigen::Vector2d(std::cos(slope_direction_rad), std::sin(slope_direction_rad));
  terrain.pivot_m = area_m.center();
  const int material = use_material(draft, reader, "material", reader.text("material"));
  reader.finish();

  draft.seabed = sample_terrain(terrain, key.child("shape"), area_m, spacing_m);
  const int mesh = add_mesh(draft, reader, slab_mesh(draft.seabed, thickness_m));
  add_instance(draft, reader, {"seabed", mesh, material, Eigen::Affine3d::Identity(), true});
}

void add_surface(Reader& file, SceneDraft& draft, RandomKey layout_key) {
  if (!file.has("surface") || (file.node("surface").IsScalar() && file.text("surface") == "none")) return;
  Reader reader = file.child("surface");
  const RandomKey key = layout_key.child("surface");
  RandomSequence random(key);
  const FieldSampler field{reader, random};
  Terrain terrain;
  terrain.fractal_rms_m = field.number_or("roughness_m", 0.01, {0, 5});
  terrain.fractal_wavelength_m = field.number_or("wavelength_m", 2, {0.05, 1e3});
  const double spacing_m = reader.number_or("spacing_m", 0.4, {1e-3, 100});
  const double margin_m = field.number_or("margin_m", 5, {0, 1e4});
  const Eigen::AlignedBox2d area_m = widened(draft.scene.bounds_m, margin_m);
  check_grid_size(reader, area_m.sizes(), spacing_m);
  terrain.fractal_finest_m = 2 * spacing_m;
  const int material = use_material(draft, reader, "material", reader.text_or("material", "water_surface"));
  reader.finish();

  const int mesh =
      add_mesh(draft, reader, sheet_mesh(sample_terrain(terrain, key.child("shape"), area_m, spacing_m), false));
  add_instance(draft, reader, {"water_surface", mesh, material, Eigen::Affine3d::Identity(), false});
}

std::vector<Material> all_materials(Reader& file) {
  std::vector<Material> materials;
  if (file.has("materials")) {
    Reader table = file.child("materials");
    materials = read_materials(table);
  }
  // After those of the file, which so win over bundled ones of the same name.
  for (Material& bundled : bundled_materials()) materials.push_back(std::move(bundled));
  return materials;
}

}  // namespace

Scene load_scene(const ConfigSource& source, std::uint64_t layout) {
  Reader file = open_config("scenes", source);
  const RandomKey layout_key = RandomKey::from_seed(layout);

  SceneDraft draft;
  Scene& scene = draft.scene;
  scene.layout = layout;
  scene.name = file.text_or("name", std::filesystem::path(file.source_name()).stem().string());
  scene.title = file.text_or("title", scene.name);
  scene.water = read_water(file);
  read_extent(file, scene);
  take_waypoints(file, scene);
  draft.known_materials = all_materials(file);

  add_seabed(file, draft, layout_key);
  add_surface(file, draft, layout_key);
  std::set<std::string> names{"seabed", "surface", "water_surface"};
  for (Reader& object : file.children("objects")) {
    const std::string name = object.text("name");
    if (!names.insert(name).second) object.fail("name", fmt::format("'{}' is taken; names must be unique", name));
    add_object(draft, object, layout_key);
  }
  file.finish();
  if (scene.instances.empty()) file.fail("", "holds nothing; give a seabed or objects");
  return std::move(draft.scene);
}

std::vector<std::filesystem::path> scene_mesh_files(const std::string& path_or_name) {
  Reader file = Reader::from_file(resolve_name("scenes", path_or_name));
  std::vector<std::filesystem::path> files;
  for (Reader& object : file.children("objects")) {
    if (object.has("mesh")) files.push_back(mesh_path(object));
  }
  return files;
}

}  // namespace ensonify
