#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "ensonify/scenes/scene.hpp"
#include "ensonify/sim/bistatic.hpp"

struct RTCSceneTy;
struct RTCDeviceTy;

namespace ensonify {

/// Instruction set Embree may use. Ranges differ in their last bits between sets, so it is part of a result.
inline constexpr const char* default_isa = "avx2";

/// A scene ready for casting: Embree's hierarchy over all triangles, and what each of them is. Immutable; any number
/// of threads may cast at once. Small instances are copied into the world, large shared meshes stay Embree instances.
class RayScene {
 public:
  /// What a hit's geometry stands for; index = Embree's top-level geometry id.
  struct Surface {
    int instance = 0;  ///< index into Scene::instances
    int material = 0;  ///< index into Scene::materials
    bool instanced = false;
    Eigen::Matrix3f normal_to_world = Eigen::Matrix3f::Identity();  ///< inverse transpose; used where instanced
  };

  /// `isa`: avx2, avx512, sse4.2, sse2 or auto. Throws ConfigError for another, DataError where Embree fails.
  explicit RayScene(const Scene& scene, const std::string& isa = default_isa);

  RTCSceneTy* handle() const { return scene_.get(); }
  const std::vector<Surface>& surfaces() const { return surfaces_; }
  /// Of material m: backscatter(i) / cos(i) at table points (see `scatter_steps`), one material after the other.
  const std::vector<float>& scatter_table() const { return scatter_table_; }

  /// Of every material, for multipath.
  const std::vector<SurfaceLaw>& laws() const { return laws_; }

  /// Points of a material's table are equidistant in sqrt(1 - cos i), which is linear in i near normal incidence,
  /// where the specular lobe is sharp.
  static constexpr int scatter_steps = 1023;
  static constexpr int scatter_stride = scatter_steps + 2;

 private:
  std::shared_ptr<RTCDeviceTy> device_;
  std::shared_ptr<RTCSceneTy> scene_;
  std::vector<std::shared_ptr<RTCSceneTy>> shared_meshes_;
  std::vector<Surface> surfaces_;
  std::vector<float> scatter_table_;
  std::vector<SurfaceLaw> laws_;
};

}  // namespace ensonify
