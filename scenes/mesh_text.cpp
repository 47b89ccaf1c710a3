#include "ensonify/scenes/mesh_text.hpp"

#include <cstdint>
#include <cstring>

namespace ensonify {

std::string stl_fault(std::string_view bytes) {
  constexpr std::size_t header = 84, facet = 50;
  std::uint32_t facets = 0;
  if (bytes.size() >= header) std::memcpy(&facets, bytes.data() + 80, sizeof facets);
  const bool fits_as_binary = bytes.size() >= header && bytes.size() == header + facet * std::size_t{facets};
  if (fits_as_binary) return {};
  if (bytes.starts_with("solid") && bytes.find('\0') == std::string_view::npos) {
    const std::size_t last = bytes.rfind("endsolid");
    const bool ends = last != std::string_view::npos && bytes.find("facet", last) == std::string_view::npos;
    return ends ? std::string{} : "the file is cut short: no 'endsolid' at its end";
  }
  if (bytes.size() < header + facet * std::size_t{facets}) return "the file is cut short, or is no STL";
  return {};
}

std::string mesh_text_fault(std::string_view bytes, MeshFormat format) {
  // UTF-16 or an archive would hide its content from the checks below.
  const bool binary_allowed = format == MeshFormat::stl || format == MeshFormat::ply || bytes.starts_with("glTF");
  if (!binary_allowed && bytes.find('\0') != std::string_view::npos) return "it is no plain text in UTF-8";
  switch (format) {
    case MeshFormat::obj:
      return {};
    case MeshFormat::ply:
      return ply_fault(bytes);
    case MeshFormat::stl:
      return stl_fault(bytes);
    case MeshFormat::gltf:
      return gltf_fault(bytes);
    case MeshFormat::collada:
      return collada_fault(bytes);
  }
  return {};
}

}  // namespace ensonify
