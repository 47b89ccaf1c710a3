#include "ensonify/scenes/mesh_files.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <string_view>
#include <vector>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* extension;
  MeshFormat format;
};
constexpr std::array<Known, 6> known{{{"obj", MeshFormat::obj},
                                      {"ply", MeshFormat::ply},
                                      {"stl", MeshFormat::stl},
                                      {"gltf", MeshFormat::gltf},
                                      {"glb", MeshFormat::gltf},
                                      {"dae", MeshFormat::collada}}};

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

MeshFormat mesh_format(const fs::path& path) {
  const std::string extension = lower_extension(path);
  for (const Known& k : known) {
    if (extension == k.extension) return k.format;
  }
  throw DataError(
      fmt::format("{}: no mesh format that is read; use .obj, .ply, .stl, .gltf, .glb or .dae", path.string()));
}

std::string format_name(MeshFormat format) {
  switch (format) {
    case MeshFormat::obj:
      return "OBJ";
    case MeshFormat::ply:
      return "PLY";
    case MeshFormat::stl:
      return "STL";
    case MeshFormat::gltf:
      return "glTF 2";
    case MeshFormat::collada:
      return "COLLADA";
  }
  return "mesh";
}

void keep_only_importers_of(MeshFormat format, Assimp::Importer& importer) {
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    const aiImporterDesc& info = *importer.GetImporterInfo(i);
    const bool wanted = std::any_of(known.begin(), known.end(), [&](const Known& k) {
      const std::string list = fmt::format(" {} ", info.mFileExtensions);
      return k.format == format && list.find(fmt::format(" {} ", k.extension)) != std::string::npos;
    });
    // glTF 1 shares its extensions with glTF 2 and has a reader of its own.
    if (!wanted || std::string_view(info.mName) == "glTF Importer") others.push_back(importer.GetImporter(i));
  }
  for (Assimp::BaseImporter* other : others) {
    importer.UnregisterLoader(other);
    delete other;  // UnregisterLoader hands the reader back
  }
}

FolderOnlyFiles::FolderOnlyFiles(const fs::path& mesh) {
  std::error_code no_throw;
  mesh_ = fs::canonical(mesh, no_throw);
}

bool FolderOnlyFiles::allowed(const char* file) const {
  std::error_code error;
  const fs::path path = fs::canonical(file, error);
  if (error || !fs::is_regular_file(path, error) || fs::file_size(path, error) > max_mesh_file_bytes) return false;
  if (path == mesh_) return true;
  const fs::path inside = path.lexically_relative(mesh_.parent_path());
  return lower_extension(path) == "bin" && !inside.empty() && *inside.begin() != "..";
}

bool FolderOnlyFiles::Exists(const char* file) const { return allowed(file) && DefaultIOSystem::Exists(file); }

Assimp::IOStream* FolderOnlyFiles::Open(const char* file, const char* mode) {
  const bool reads = std::strchr(mode, 'r') != nullptr && std::strchr(mode, '+') == nullptr;
  return reads && allowed(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
}

}  // namespace ensonify
