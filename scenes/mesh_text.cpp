#include "ensonify/scenes/mesh_text.hpp"

namespace ensonify {

std::string mesh_text_fault(std::string_view, MeshFormat) { return {}; }

}  // namespace ensonify
