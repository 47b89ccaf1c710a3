#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// Where the cells of a grid lie. Cell (ix, iy, iz) spans origin + resolution * [i, i + 1) on each axis, world frame.
struct GridFrame {
  Vec3 origin_m = Vec3::Zero();  ///< minimum corner of cell (0, 0, 0)
  double resolution_m = 0;
  std::array<int, 3> size{};  ///< cells along x, y, z

  std::size_t cells() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
  /// x runs fastest: the layout of a C-ordered array [z, y, x].
  std::size_t index(int ix, int iy, int iz) const {
    return (static_cast<std::size_t>(iz) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(iy)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(ix);
  }
  bool contains(int ix, int iy, int iz) const {
    return ix >= 0 && iy >= 0 && iz >= 0 && ix < size[0] && iy < size[1] && iz < size[2];
  }
  std::array<int, 3> cell_of(const Vec3& p_world) const {
    const Vec3 c = (p_world - origin_m) / resolution_m;
    return {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
            static_cast<int>(std::floor(c.z()))};
  }
  Vec3 centre_m(int ix, int iy, int iz) const { return origin_m + resolution_m * Vec3(ix + 0.5, iy + 0.5, iz + 0.5); }
};

enum class Occupancy : std::uint8_t {
  free = 0,
  surface = 1,   ///< a triangle touches the cell
  interior = 2,  ///< inside a solid, never seen by a sonar
};

/// Ground-truth occupancy, and which cells a set of pings could observe.
struct OccupancyGrid {
  GridFrame frame;
  std::vector<std::uint8_t> occupancy;   ///< `Occupancy`, one a cell
  std::vector<std::uint8_t> observable;  ///< 0 or 1, one a cell; empty before any ping
};

}  // namespace ensonify
