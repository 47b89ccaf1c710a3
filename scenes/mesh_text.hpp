#pragma once

#include <string>
#include <string_view>

#include "ensonify/scenes/mesh_files.hpp"

namespace ensonify {

/// What is wrong with the bytes of a mesh file before any parser sees them; empty if nothing is found.
std::string mesh_text_fault(std::string_view bytes, MeshFormat format);

}  // namespace ensonify
