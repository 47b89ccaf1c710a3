#include "ensonify/scenes/scene_export.hpp"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Exporter.hpp>
#include <map>
#include <memory>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

/// Assimp's scenes own raw arrays and release them with delete[].
template <typename T>
T* owned_array(std::size_t n) {
  return n == 0 ? nullptr : new T[n];
}

aiVector3D as_vector(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

aiMatrix4x4 as_matrix(const Eigen::Affine3d& T) {
  const Eigen::Matrix4f m = T.matrix().cast<float>();
  return {m(0, 0), m(0, 1), m(0, 2), m(0, 3), m(1, 0), m(1, 1), m(1, 2), m(1, 3),
          m(2, 0), m(2, 1), m(2, 2), m(2, 3), m(3, 0), m(3, 1), m(3, 2), m(3, 3)};
}

std::unique_ptr<aiMesh> as_mesh(const TriangleMesh& mesh, const Eigen::Affine3d& T, int material) {
  auto result = std::make_unique<aiMesh>();
  result->mMaterialIndex = static_cast<unsigned>(material);
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mNumVertices = static_cast<unsigned>(mesh.vertices_m.size());
  result->mVertices = owned_array<aiVector3D>(mesh.vertices_m.size());
  for (std::size_t v = 0; v < mesh.vertices_m.size(); ++v) {
    result->mVertices[v] = as_vector(T * mesh.vertices_m[v].cast<double>());
  }
  result->mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  result->mFaces = owned_array<aiFace>(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    result->mFaces[t].mNumIndices = 3;
    result->mFaces[t].mIndices = new unsigned[3]{mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
  }
  return result;
}

aiMaterial* as_material(const Material& material) {
  auto* result = new aiMaterial;
  const aiString name(material.name);
  const aiColor4D colour(material.colour[0], material.colour[1], material.colour[2], 1);
  const float roughness = 1, metallic = 0;
  result->AddProperty(&name, AI_MATKEY_NAME);
  result->AddProperty(&colour, 1, AI_MATKEY_COLOR_DIFFUSE);
  result->AddProperty(&colour, 1, AI_MATKEY_BASE_COLOR);
  result->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  result->AddProperty(&metallic, 1, AI_MATKEY_METALLIC_FACTOR);
  return result;
}

struct Draft {
  std::vector<std::unique_ptr<aiMesh>> meshes;
  std::vector<std::unique_ptr<aiNode>> nodes;
};

std::unique_ptr<aiNode> node_of(const std::string& name, unsigned mesh) {
  auto node = std::make_unique<aiNode>(name);
  node->mNumMeshes = 1;
  node->mMeshes = new unsigned[1]{mesh};
  return node;
}

/// A node an instance; one assimp mesh for each pair of mesh and material.
Draft as_nodes(const Scene& scene, const std::vector<Instance>& instances) {
  Draft draft;
  std::map<std::pair<int, int>, unsigned> known;
  for (const Instance& instance : instances) {
    const auto [entry, is_new] =
        known.try_emplace({instance.mesh, instance.material}, static_cast<unsigned>(draft.meshes.size()));
    if (is_new) {
      draft.meshes.push_back(as_mesh(scene.meshes[static_cast<std::size_t>(instance.mesh)], Eigen::Affine3d::Identity(),
                                     instance.material));
    }
    draft.nodes.push_back(node_of(instance.name, entry->second));
    draft.nodes.back()->mTransformation = as_matrix(instance.T_world_object);
  }
  return draft;
}

/// Everything in the world frame.
Draft as_world_meshes(const Scene& scene, const std::vector<Instance>& instances) {
  Draft draft;
  for (const Instance& instance : instances) {
    draft.nodes.push_back(node_of(instance.name, static_cast<unsigned>(draft.meshes.size())));
    draft.meshes.push_back(
        as_mesh(scene.meshes[static_cast<std::size_t>(instance.mesh)], instance.T_world_object, instance.material));
  }
  return draft;
}

template <typename T>
T** released(std::vector<std::unique_ptr<T>>& items) {
  T** array = owned_array<T*>(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) array[i] = items[i].release();
  return array;
}

}  // namespace

std::vector<std::uint8_t> export_scene(const Scene& scene, const std::string& format, bool with_surface) {
  static const std::map<std::string, const char*> assimp_names{
      {".glb", "glb2"}, {".obj", "objnomtl"}, {".ply", "plyb"}, {".stl", "stlb"}};
  const auto known = assimp_names.find(format);
  if (known == assimp_names.end()) {
    throw ConfigError(fmt::format("'{}' is no format of meshes to write; use .glb, .obj, .ply or .stl", format));
  }
  std::vector<Instance> instances;
  for (const Instance& instance : scene.instances) {
    if (instance.obstacle || with_surface) instances.push_back(instance);
  }
  Draft draft = format == ".glb" ? as_nodes(scene, instances) : as_world_meshes(scene, instances);

  aiScene out;
  out.mRootNode = new aiNode(scene.name);
  if (format == ".glb") {  // z up -> y up
    out.mRootNode->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  }
  for (const auto& node : draft.nodes) node->mParent = out.mRootNode;
  out.mRootNode->mNumChildren = static_cast<unsigned>(draft.nodes.size());
  out.mRootNode->mChildren = released(draft.nodes);
  out.mNumMeshes = static_cast<unsigned>(draft.meshes.size());
  out.mMeshes = released(draft.meshes);
  out.mNumMaterials = static_cast<unsigned>(scene.materials.size());
  out.mMaterials = owned_array<aiMaterial*>(scene.materials.size());
  for (std::size_t m = 0; m < scene.materials.size(); ++m) out.mMaterials[m] = as_material(scene.materials[m]);

  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&out, known->second);
  if (blob == nullptr) {
    throw DataError(
        fmt::format("scene {}: assimp can not write it as {}: {}", scene.name, format, exporter.GetErrorString()));
  }
  const auto* bytes = static_cast<const std::uint8_t*>(blob->data);
  return {bytes, bytes + blob->size};
}

}  // namespace ensonify
