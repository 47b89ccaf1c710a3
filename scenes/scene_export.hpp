#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensonify/scenes/scene.hpp"

namespace ensonify {

/// The whole scene as the bytes of one mesh file: `format` is .glb (a node an instance, meshes shared, materials with
/// names and colours; glTF's frame: metres, y up), .obj, .ply or .stl (one mesh in the world frame, metres, z up).
/// Surfaces that are no obstacle, such as the water's, are left out unless asked for.
/// Throws ConfigError (another format), DataError (assimp can not write it).
std::vector<std::uint8_t> export_scene(const Scene& scene, const std::string& format, bool with_surface = false);

}  // namespace ensonify
