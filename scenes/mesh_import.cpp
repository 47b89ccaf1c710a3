#include "ensonify/scenes/mesh_import.hpp"

#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <string_view>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_files.hpp"
#include "ensonify/scenes/mesh_guard.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/mesh_weld.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_triangles = 50'000'000;
constexpr std::size_t max_nodes = 1'000'000;

Eigen::Matrix4d eigen(const aiMatrix4x4& m) {
  return Eigen::Map<const Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>>(&m.a1).cast<double>();
}

/// Turns a frame whose `up` axis points up into one with z up.
Eigen::Matrix3d z_up_from(UpAxis up) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  if (up == UpAxis::y) m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == UpAxis::x) m << 0, -1, 0, 0, 0, -1, 1, 0, 0;  // right is -y, in is z, as in COLLADA
  return m;
}

/// MeshLab writes `Y_UP` into every COLLADA file, whatever its coordinates mean; robot models that passed through it
/// are nearly always drawn with z up.
bool up_axis_is_hollow(const aiScene& scene, MeshFormat format) {
  aiString tool;
  return format == MeshFormat::collada && scene.mMetaData != nullptr &&
         scene.mMetaData->Get(AI_METADATA_SOURCE_GENERATOR, tool) &&
         std::string_view(tool.C_Str()).find("MeshLab") != std::string_view::npos;
}

/// What assimp hands over: COLLADA comes in metres with y up (unless told to leave the axis alone), glTF as it is by
/// its definition, the others without unit or axis.
Eigen::Matrix3d metres_z_up(const aiScene& scene, MeshFormat format, const MeshImportOptions& options) {
  double unit_m = options.unit_m.value_or(1.0);
  if (format == MeshFormat::collada && options.unit_m) {
    const double file_unit_m = std::cbrt(std::abs(eigen(scene.mRootNode->mTransformation).determinant()));
    if (file_unit_m > 0) unit_m /= file_unit_m;
  }
  const bool y_up_by_format =
      (format == MeshFormat::collada && !up_axis_is_hollow(scene, format)) || format == MeshFormat::gltf;
  return options.scale * unit_m * z_up_from(options.up_axis.value_or(y_up_by_format ? UpAxis::y : UpAxis::z));
}

/// Before the triangulation, whose assertions abort the program.
void check_faces(const aiScene& scene, const std::string& file) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices == 0) throw DataError(fmt::format("{}: a face has no corners", file));
    }
  }
}

struct Visit {
  const aiNode* node;
  Eigen::Matrix4d T_world_parent;
};

void append(const aiMesh& part, const Eigen::Matrix4d& T, const std::string& file, TriangleMesh& mesh) {
  if (mesh.triangles.size() + part.mNumFaces > max_triangles) {
    throw DataError(fmt::format("{}: more than {} triangles; reduce the mesh", file, max_triangles));
  }
  const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Eigen::Vector4d p = T * Eigen::Vector4d(v.x, v.y, v.z, 1.0);
    mesh.vertices_m.push_back(p.head<3>().cast<float>());
  }
  const bool mirrored = T.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (unsigned corner = 0; corner < 3; ++corner) {
      if (face.mIndices[corner] >= part.mNumVertices) {
        throw DataError(
            fmt::format("{}: a face names vertex {} of {}", file, face.mIndices[corner], part.mNumVertices));
      }
      triangle[corner] = first + face.mIndices[corner];
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
}

TriangleMesh flatten(const aiScene& scene, const Eigen::Matrix3d& to_metres_z_up, const std::string& file) {
  Eigen::Matrix4d root = Eigen::Matrix4d::Identity();
  root.topLeftCorner<3, 3>() = to_metres_z_up;
  TriangleMesh mesh;
  std::vector<Visit> pending{{scene.mRootNode, root}};
  std::size_t visited = 0;
  while (!pending.empty()) {
    const Visit visit = pending.back();
    pending.pop_back();
    if (++visited > max_nodes) throw DataError(fmt::format("{}: more than {} nodes", file, max_nodes));
    const Eigen::Matrix4d T = visit.T_world_parent * eigen(visit.node->mTransformation);
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
      if (visit.node->mMeshes[i] >= scene.mNumMeshes) throw DataError(fmt::format("{}: names a missing mesh", file));
      append(*scene.mMeshes[visit.node->mMeshes[i]], T, file, mesh);
    }
    for (unsigned i = visit.node->mNumChildren; i-- > 0;) pending.push_back({visit.node->mChildren[i], T});
  }
  return mesh;
}

constexpr std::string_view offset_cure =
    "subtract an offset from its vertices (of a georeferenced mesh, the easting and northing of its corner)";

void check_left_out(const Welded& welded, const std::string& file, std::vector<std::string>& warnings) {
  const std::size_t left = welded.mesh.triangles.size();
  const std::size_t all = welded.flat + welded.out_of_reach + left;
  const std::string far = fmt::format(
      "further than {:.0f} km from the origin or nowhere finite, where single "
      "precision holds no shape; {}, or check `unit` and `scale`",
      weld_reach_m * 1e-3f, offset_cure);
  if (left == 0 && welded.out_of_reach > 0) {
    throw DataError(fmt::format("{}: {} of {} triangles lie {}", file, welded.out_of_reach, all, far));
  }
  if (left == 0) throw DataError(fmt::format("{}: holds no triangle of any area", file));
  if (welded.flat > 0) {
    warnings.push_back(fmt::format("{}: {} of {} triangles have no area and are left out", file, welded.flat, all));
  }
  if (welded.out_of_reach > 0) {
    warnings.push_back(
        fmt::format("{}: {} of {} triangles are left out: they lie {}", file, welded.out_of_reach, all, far));
  }
}

void warn_of_coarse_coordinates(const TriangleMesh& mesh, const std::string& file, std::vector<std::string>& warnings) {
  constexpr float finest_needed_m = 1e-3f;
  float largest_m = 0;
  for (const Eigen::Vector3f& v : mesh.vertices_m) largest_m = std::max(largest_m, v.cwiseAbs().maxCoeff());
  const float step_m = std::nextafter(largest_m, weld_reach_m * 2) - largest_m;
  if (step_m <= finest_needed_m) return;
  warnings.push_back(fmt::format("{}: has coordinates of {:.0f} m, which single precision rounds to {:.2g} mm; {}",
                                 file, largest_m, step_m * 1e3f, offset_cure));
}

void warn_of_odd_size(const TriangleMesh& mesh, MeshFormat format, const MeshImportOptions& options,
                      const std::string& file, std::vector<std::string>& warnings) {
  // COLLADA and glTF state their unit; a user who gave unit or scale has thought of it.
  if (options.unit_m || options.scale != 1 || format == MeshFormat::gltf) return;
  constexpr double largest_likely_m = 50;
  constexpr double smallest_likely_m = 0.01;
  const double extent_m = bounding_box_m(mesh).sizes().maxCoeff();
  if (extent_m > largest_likely_m) {
    warnings.push_back(fmt::format(
        "{}: {:.4g} m in its largest extent, so it may be drawn in millimetres; if so give `unit: mm`, else `unit: m`",
        file, extent_m));
  } else if (extent_m < smallest_likely_m) {
    warnings.push_back(
        fmt::format("{}: only {:.4g} m in its largest extent; check `unit` and `scale`", file, extent_m));
  }
}

}  // namespace

TriangleMesh import_mesh(const fs::path& path, const MeshImportOptions& options, std::vector<std::string>& warnings) {
  const std::string file = path.string();
  const MeshFormat format = mesh_format(path);
  check_mesh_file(path, format);

  Assimp::Importer importer;
  keep_only_importers_of(format, importer);
  importer.SetIOHandler(new FolderOnlyFiles(path));  // owned by the importer
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, options.up_axis.has_value());
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file, aiProcess_ValidateDataStructure);
  if (scene != nullptr) {
    check_faces(*scene, file);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw DataError(fmt::format("{}: can not be read as {}: {}", file, format_name(format), importer.GetErrorString()));
  }

  if (!options.up_axis && up_axis_is_hollow(*scene, format)) {
    warnings.push_back(fmt::format(
        "{}: MeshLab marks every COLLADA file Y_UP; z is taken as up, give `up_axis: y` if it lies on its side", file));
  }
  const Welded welded = weld(flatten(*scene, metres_z_up(*scene, format, options), file));
  check_left_out(welded, file, warnings);
  warn_of_coarse_coordinates(welded.mesh, file, warnings);
  warn_of_odd_size(welded.mesh, format, options, file, warnings);
  return welded.mesh;
}

}  // namespace ensonify
