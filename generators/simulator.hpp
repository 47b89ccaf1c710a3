#pragma once

#include <string>

#include "ensonify/generators/form_images.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

/// What is random in a ping. `seed` names the world: scatterers, the device and the noise parameters that are drawn;
/// `ping` the moment: another one has new receiver noise over the same speckle.
struct PingKeys {
  RandomKey seed{};
  RandomKey ping{};
};

/// The keys of ping number `frame` of a sonar at rest.
PingKeys ping_keys(std::uint64_t seed, std::uint64_t frame);

struct PingRequest {
  Pose T_world_sonar = Pose::Identity();
  Twist motion{};  ///< while the sound is under way
  PingKeys keys{};
  bool cell_truth = true;
};

struct SimulatedPing {
  Ping ping;
  PingImages images;
  SampledValues sampled;  ///< noise parameters that were drawn
};

/// A sonar in a place: pose -> images and truth, a pure function. Any number of threads may call at once.
class Simulator {
 public:
  /// Keeps nothing of the scene's meshes but the ray caster's copy. Throws ConfigError where the noise does not fit the
  /// sonar, DataError where Embree fails.
  Simulator(const Scene& scene, const SonarModel& sonar, NoiseProfile noise, const std::string& isa = default_isa,
            int mask_threshold = default_mask_threshold);
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  SimulatedPing ping(const PingRequest& request) const;

  const SonarModel& sonar() const { return receiver_.sonar; }

 private:
  std::string scene_name_;
  NoiseProfile noise_;
  int mask_threshold_;
  RayScene rays_;
  Receiver receiver_;
  double absorption_db_per_m_;
  PingTracer tracer_;
};

}  // namespace ensonify
