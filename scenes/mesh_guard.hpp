#pragma once

#include <filesystem>

#include "ensonify/scenes/mesh_files.hpp"

namespace ensonify {

/// Refuses with DataError what assimp would misread or fall over: a missing, empty or oversized file, one cut short,
/// text nested too deep, and COLLADA or glTF nodes that contain themselves or multiply beyond reason.
void check_mesh_file(const std::filesystem::path& path, MeshFormat format);

}  // namespace ensonify
