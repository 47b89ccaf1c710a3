#pragma once

#include <string>
#include <string_view>

#include "ensonify/scenes/mesh_files.hpp"

namespace ensonify {

/// What is wrong with the bytes of a mesh file, before any parser sees them: cut short, nested or repeated without end,
/// lists longer than the file. Empty if nothing is found, which does not prove that the file is right.
std::string mesh_text_fault(std::string_view bytes, MeshFormat format);

std::string collada_fault(std::string_view xml);
std::string gltf_fault(std::string_view bytes);
std::string ply_fault(std::string_view bytes);
std::string stl_fault(std::string_view bytes);

}  // namespace ensonify
