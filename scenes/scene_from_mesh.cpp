#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/material_library.hpp"
#include "ensonify/scenes/mesh_import.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene.hpp"

namespace ensonify {

Scene scene_from_mesh(const std::filesystem::path& mesh) {
  Scene scene;
  scene.name = mesh.stem().string();
  scene.title = mesh.filename().string();
  scene.meshes.push_back(import_mesh(mesh, {}, scene.warnings));
  scene.mesh_files.push_back(mesh);
  for (const Material& material : bundled_materials()) {
    if (material.name == "steel_rusty") scene.materials.push_back(material);
  }
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.instances.push_back({scene.name, 0, 0, Eigen::Affine3d::Identity(), true});

  const Eigen::AlignedBox3d box = bounding_box_m(scene.meshes.front());
  // At least a centimetre, so that a flat mesh has bounds too.
  const Vec3 margin = (0.05 * box.sizes()).cwiseMax(0.01);
  scene.bounds_m = Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  scene.navigable_m = scene.bounds_m;
  constexpr double max_cells = 64e6;
  scene.grid_resolution_m = std::max(0.05, std::cbrt(scene.bounds_m.volume() / (0.5 * max_cells)));
  return scene;
}

Scene open_scene(const ConfigSource& source, std::uint64_t layout) {
  const auto* word = std::get_if<std::string>(&source);
  if (word == nullptr) return load_scene(source, layout);
  const std::filesystem::path path = *word;
  if (!path.has_extension() || path.extension() == ".yaml" || path.extension() == ".yml") {
    return load_scene(source, layout);
  }
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) throw DataError(fmt::format("{}: no such file", *word));
  return scene_from_mesh(path);
}

}  // namespace ensonify
