#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

enum class UpAxis { x, y, z };

/// What the file does not say, or says wrongly.
struct MeshImportOptions {
  double scale = 1;               ///< factor on top of the unit
  std::optional<double> unit_m;   ///< metres a file unit; absent: that of the file, else metres
  std::optional<UpAxis> up_axis;  ///< absent: that of the file or format (COLLADA, glTF), else z
};

/// Reads .obj .ply .stl .gltf .glb .dae into one mesh in metres with z up: node transforms, unit and up axis applied,
/// identical vertices welded, degenerate and non-finite triangles dropped (with a warning), points and lines ignored.
/// The file is not trusted: it may name other files only below its own folder, and what is broken, too large or refers
/// to itself throws DataError. A size that looks like another unit is warned of.
TriangleMesh import_mesh(const std::filesystem::path& path, const MeshImportOptions& options,
                         std::vector<std::string>& warnings);

}  // namespace ensonify
