#pragma once

#include <assimp/DefaultIOSystem.h>

#include <assimp/Importer.hpp>
#include <filesystem>
#include <string>

namespace ensonify {

enum class MeshFormat { obj, ply, stl, gltf, collada };

/// By extension. Throws DataError for any other, naming those that are read.
MeshFormat mesh_format(const std::filesystem::path& path);
std::string format_name(MeshFormat format);

constexpr std::uintmax_t max_mesh_file_bytes = std::uintmax_t{1} << 30;

/// Takes from assimp the readers of all other formats, so that a file can not choose its reader by content.
void keep_only_importers_of(MeshFormat format, Assimp::Importer& importer);

/// Opens the mesh itself and .bin buffers below its folder, both up to 1 GiB, and nothing else: a mesh file may name
/// any path, a device or a secret among them.
class FolderOnlyFiles : public Assimp::DefaultIOSystem {
 public:
  explicit FolderOnlyFiles(const std::filesystem::path& mesh);
  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;

 private:
  bool allowed(const char* file) const;
  std::filesystem::path mesh_;
};

}  // namespace ensonify
