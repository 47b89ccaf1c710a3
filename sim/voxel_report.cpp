#include "ensonify/sim/voxel_report.hpp"

#include <fmt/format.h>

namespace ensonify {

std::string VoxelReport::describe() const {
  const std::string closed = watertight ? "watertight" : fmt::format("not watertight ({} open edges)", open_edges);
  std::string line = fmt::format(
      "{}: {} triangles, {}, solid by {}, {} surface + {} interior cells", name.empty() ? "object" : name, triangles,
      closed, method == SolidMethod::parity ? "parity" : "flood from outside", surface_cells, interior_cells);
  if (nonmanifold_edges > 0) line += fmt::format(", {} edges of more than two triangles", nonmanifold_edges);
  if (inside_out) line += ", faces turned inwards (taken as outwards)";
  if (unlike_edges > 0) {
    line += fmt::format(", {} edges between faces that are turned differently (make normals consistent)", unlike_edges);
  }
  if (parity_disagreements > 0) line += fmt::format(", {} cells where the axes disagree", parity_disagreements);
  if (method == SolidMethod::outside_fill && interior_cells == 0) line += ", a shell without inside";
  return line;
}

}  // namespace ensonify
