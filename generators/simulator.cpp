#include "ensonify/generators/simulator.hpp"

namespace ensonify {

PingKeys ping_keys(std::uint64_t seed, std::uint64_t frame) {
  const RandomKey key = RandomKey::from_seed(seed);
  const RandomKey first = key.child("noise");
  return {key, frame == 0 ? first : first.child(frame)};
}

Simulator::Simulator(const Scene& scene, const SonarModel& sonar, NoiseProfile noise, const std::string& isa,
                     int mask_threshold)
    : scene_name_(scene.name),
      noise_(std::move(noise)),
      mask_threshold_(mask_threshold),
      rays_(scene, isa),
      receiver_(sonar),
      absorption_db_per_m_(absorption_db_per_m(scene.water, sonar.frequency_hz)),
      tracer_(rays_, sonar, scene.water) {
  check_noise(noise_, sonar);
}

SimulatedPing Simulator::ping(const PingRequest& request) const {
  SimulatedPing result;
  const RandomKey& seed = request.keys.seed;
  const ImageSettings settings{sample_noise(noise_, seed.child("noise parameters"), result.sampled), 0.0,
                               mask_threshold_};
  TraceOptions options = trace_options(settings.noise, request.cell_truth);
  options.motion = request.motion;
  result.ping = tracer_.trace(request.T_world_sonar, options);
  const PingSetting setting{request.T_world_sonar, seed.child("surface").child(scene_name_),
                            seed.child("device").child(receiver_.sonar.name), request.keys.ping, absorption_db_per_m_};
  result.images = form_images(receiver_, result.ping, settings, setting);
  return result;
}

}  // namespace ensonify
