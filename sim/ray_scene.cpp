#include "ensonify/sim/ray_scene.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ensonify/core/error.hpp"
#include "ensonify/sim/flush_denormals.hpp"

namespace ensonify {
namespace {

/// A mesh used more than once stays one Embree instance each where copies would cost more triangles than this; below,
/// copies are cheaper to cast into than a second level.
constexpr std::size_t max_copied_triangles = 200'000;

std::shared_ptr<RTCDeviceTy> make_device(const std::string& isa) {
  static constexpr std::array known{"auto", "sse2", "sse4.2", "avx2", "avx512"};
  if (std::find(known.begin(), known.end(), isa) == known.end()) {
    throw ConfigError(fmt::format("isa '{}': must be one of auto, sse2, sse4.2, avx2, avx512", isa));
  }
  RTCDevice device = rtcNewDevice(isa == "auto" ? "" : fmt::format("isa={}", isa).c_str());
  if (device == nullptr) {
    throw DataError(fmt::format("Embree refuses instruction set '{}' on this processor (error {}); try --isa auto", isa,
                                static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  return {device, rtcReleaseDevice};
}

std::shared_ptr<RTCSceneTy> make_scene(RTCDevice device) {
  std::shared_ptr<RTCSceneTy> scene(rtcNewScene(device), rtcReleaseScene);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // no leaks between neighbouring triangles
  return scene;
}

unsigned attach_mesh(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, const Eigen::Affine3d& T_scene_mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices_m.size()));
  auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
  if (vertices == nullptr || triangles == nullptr) {
    rtcReleaseGeometry(geometry);
    throw DataError(fmt::format("no memory for a mesh of {} triangles", mesh.triangles.size()));
  }
  for (std::size_t v = 0; v < mesh.vertices_m.size(); ++v) {
    const Eigen::Vector3f p = (T_scene_mesh * mesh.vertices_m[v].cast<double>()).cast<float>();
    std::memcpy(vertices + 3 * v, p.data(), sizeof(p));
  }
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

unsigned attach_instance(RTCDevice device, RTCScene scene, RTCScene mesh, const Eigen::Affine3d& T_world_object) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh);
  const Eigen::Matrix<float, 3, 4> transform = T_world_object.matrix().topRows<3>().cast<float>();
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

std::vector<float> make_scatter_table(const std::vector<Material>& materials) {
  std::vector<float> table;
  for (const Material& material : materials) {
    for (int i = 0; i < RayScene::scatter_stride; ++i) {
      const double u = std::min(1.0, static_cast<double>(i) / RayScene::scatter_steps);
      const double cos_incidence = std::max(1.0 - u * u, 1e-6);
      table.push_back(static_cast<float>(backscatter(material, cos_incidence) / cos_incidence));
    }
  }
  return table;
}

}  // namespace

RayScene::RayScene(const Scene& scene, const std::string& isa)
    : device_(make_device(isa)),
      scene_(make_scene(device_.get())),
      shared_meshes_(scene.meshes.size()),
      scatter_table_(make_scatter_table(scene.materials)) {
  const FlushDenormals flush;
  for (const Material& material : scene.materials) laws_.push_back(surface_law(material));
  std::vector<std::size_t> uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[static_cast<std::size_t>(instance.mesh)];

  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const auto m = static_cast<std::size_t>(instance.mesh);
    const TriangleMesh& mesh = scene.meshes[m];
    Surface surface{static_cast<int>(i), instance.material, false, Eigen::Matrix3f::Identity()};
    surface.instanced = uses[m] > 1 && uses[m] * mesh.triangles.size() > max_copied_triangles;
    unsigned id = 0;
    if (surface.instanced) {
      if (!shared_meshes_[m]) {
        shared_meshes_[m] = make_scene(device_.get());
        attach_mesh(device_.get(), shared_meshes_[m].get(), mesh, Eigen::Affine3d::Identity());
        rtcCommitScene(shared_meshes_[m].get());
      }
      surface.normal_to_world = instance.T_world_object.linear().inverse().transpose().cast<float>();
      id = attach_instance(device_.get(), scene_.get(), shared_meshes_[m].get(), instance.T_world_object);
    } else {
      id = attach_mesh(device_.get(), scene_.get(), mesh, instance.T_world_object);
    }
    surfaces_.resize(std::max<std::size_t>(surfaces_.size(), id + 1));
    surfaces_[id] = surface;
  }
  if (surfaces_.empty()) {  // misses look up surface 0, also where there is none
    surfaces_.emplace_back();
    if (scatter_table_.empty()) scatter_table_.resize(scatter_stride, 0.0f);
  }
  rtcCommitScene(scene_.get());
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE) {
    throw DataError(fmt::format("scene {}: Embree could not build it (error {})", scene.name, static_cast<int>(error)));
  }
}

}  // namespace ensonify
