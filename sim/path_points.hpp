#pragma once

#include <Eigen/Core>
#include <vector>

#include "ensonify/sim/path_fan.hpp"
#include "ensonify/sim/ray_column.hpp"
#include "ensonify/sim/ray_packet.hpp"

namespace ensonify {

/// Eight places on surfaces that the sonar sees; world axes, origin at the sonar. A place with `send` 0 is none.
struct alignas(32) PathPoints {
  float x[packet_lanes], y[packet_lanes], z[packet_lanes];     ///< m
  float dx[packet_lanes], dy[packet_lanes], dz[packet_lanes];  ///< unit, from the sonar
  float nx[packet_lanes], ny[packet_lanes], nz[packet_lanes];  ///< unit normal, on the sonar's side
  float range_m[packet_lanes];
  float cos_sonar[packet_lanes];  ///< n . direction to the sonar
  float send[packet_lanes];       ///< one-way pattern / cos_sonar
  float density[packet_lanes];    ///< of the fan's points, 1/sr
  float mu[packet_lanes], specular[packet_lanes], exponent[packet_lanes], lobe_share[packet_lanes];
  float ux[packet_lanes], uy[packet_lanes], uz[packet_lanes];  ///< extent (m) of a tile's share along azimuth
  float vx[packet_lanes], vy[packet_lanes], vz[packet_lanes];  ///< and along elevation, on the tangent plane
  int column[packet_lanes];
};

/// Sets a lane to no place at all.
void clear_point(PathPoints& points, int lane);

/// Sets a lane to what a ray from the sonar along `unit` (world axes) met, or would meet, at range_m.
/// False, and no place, where that is outside of the fan.
bool set_point(PathPoints& points, int lane, const RayScene& scene, const PathFan& fan, const RayAxes& axes,
               const Eigen::Vector3f& unit, float range_m, const Eigen::Vector3f& normal, int surface);

/// A lane's place, lifted off its surface so that a ray may start there (world).
Eigen::Vector3f lifted(const PathPoints& points, int lane, const RayAxes& axes);

/// First hits of the fan's directions: one of every tile of a block of 4 x 2 tiles makes a packet, and the packets are
/// ordered by the column within the tile, then by block column, then by block row.
struct PathHits {
  static constexpr int block_tile_columns = 4;
  static constexpr int block_rows = 2;

  PathHits(const RayScene& scene, const PathFan& fan, const RayAxes& axes, float reach_m);

  int block_columns = 0;
  int block_count = 0;
  std::vector<PathPoints> packets;

  /// The packet of column `within_tile` of every tile of a block.
  const PathPoints& of(int within_tile, int block) const {
    return packets[static_cast<std::size_t>(within_tile) * static_cast<std::size_t>(block_count) +
                   static_cast<std::size_t>(block)];
  }
};

}  // namespace ensonify
