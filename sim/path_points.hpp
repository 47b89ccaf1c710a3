#pragma once

#include <Eigen/Core>
#include <vector>

#include "ensonify/sim/path_fan.hpp"
#include "ensonify/sim/path_tiles.hpp"
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
  float area_m2[packet_lanes];    ///< of surface for each sr of the fan
  float mu[packet_lanes], specular[packet_lanes], exponent[packet_lanes], lobe_share[packet_lanes];
  float ux[packet_lanes], uy[packet_lanes], uz[packet_lanes];  ///< extent (m) of a tile's share along azimuth
  float vx[packet_lanes], vy[packet_lanes], vz[packet_lanes];  ///< and along elevation, on the tangent plane
  int column[packet_lanes];                                    ///< of the PathFan
  int cell[packet_lanes];                                      ///< of the PathTiles' grid
};

/// Rays start this far off a surface: more than the error of a hit's place, less than anything modelled.
inline constexpr float lift_m = 3e-4f;

/// Sets a lane to no place at all.
void clear_point(PathPoints& points, int lane);

/// Where the paths of a ping may begin and end.
struct PathView {
  const RayScene& scene;
  const PathFan& fan;
  const PathTiles& tiles;
  RayAxes axes;
  float reach_m;  ///< of a leg
};

/// Sets a lane to what a ray from the sonar along `unit` (world axes) met, or would meet, at range_m.
/// False, and no place, where that is outside of the fan.
bool set_point(PathPoints& points, int lane, const PathView& view, const Eigen::Vector3f& unit, float range_m,
               const Eigen::Vector3f& normal, int surface);

/// A lane's place, lifted off its surface so that a ray may start there (world).
Eigen::Vector3f lifted(const PathPoints& points, int lane, const RayAxes& axes);

/// First hits of the tiles' points. A block is 8 tiles in a row; a packet holds one point of each of them.
struct PathHits {
  explicit PathHits(const PathView& view);

  int blocks = 0;
  std::vector<PathPoints> packets;

  const PathPoints& of(int block, int q) const {
    return packets[static_cast<std::size_t>(block * PathTiles::points + q)];
  }
};

}  // namespace ensonify
