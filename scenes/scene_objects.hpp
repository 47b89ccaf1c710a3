#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "ensonify/scenes/heightfield.hpp"
#include "ensonify/scenes/mesh_import.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/scenes/scene_fields.hpp"

namespace ensonify {

/// A scene while its file is read.
struct SceneDraft {
  Scene scene;
  std::vector<Material> known_materials;  ///< bundled and of this file; those used move to scene.materials
  HeightGrid seabed;                      ///< empty where the scene has none
  std::map<std::string, int> imported;    ///< mesh files read so far: options -> index into scene.meshes
  std::size_t triangles = 0;              ///< of all meshes so far
};

/// Index of a material in scene.materials, taken from the known ones on first use. Throws ConfigError at `key`.
int use_material(SceneDraft& draft, Reader& reader, std::string_view key, const std::string& name);

/// The file under `mesh` of an object, beside the scene's. Throws ConfigError where there is none.
std::filesystem::path mesh_path(Reader& reader);

/// Adds a mesh; throws ConfigError at `reader` where the scene grows beyond 10 M triangles (each mesh counted once).
int add_mesh(SceneDraft& draft, const Reader& reader, TriangleMesh mesh);

/// Adds an instance; throws ConfigError at `reader` beyond 200 000 instances.
void add_instance(SceneDraft& draft, const Reader& reader, Instance instance);

/// Reads one entry of `objects:` and adds its instances.
void add_object(SceneDraft& draft, Reader& reader, RandomKey layout_key);

}  // namespace ensonify
