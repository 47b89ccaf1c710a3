#pragma once

#include <Eigen/Core>
#include <array>

#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

inline constexpr int packet_lanes = 8;

/// Eight rays from anywhere to anywhere.
struct RayPacket {
  struct Hit {
    float distance_m = 0;
    int surface = -1;        ///< index into RayScene::surfaces, -1 for a miss
    Eigen::Vector3f normal;  ///< unit, either side
  };

  std::array<Eigen::Vector3f, packet_lanes> origin;
  std::array<Eigen::Vector3f, packet_lanes> direction;  ///< unit for `intersect`; to the other end for `occluded`
  std::array<float, packet_lanes> reach_m{};            ///< for `intersect`
  std::array<bool, packet_lanes> valid{};

  /// First surface of every valid ray within its reach.
  std::array<Hit, packet_lanes> intersect(const RayScene& scene, bool coherent) const;
  /// Whether something stands between origin and origin + direction.
  std::array<bool, packet_lanes> occluded(const RayScene& scene) const;
};

}  // namespace ensonify
