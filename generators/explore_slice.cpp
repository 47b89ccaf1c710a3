#include "ensonify/generators/explore_slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

GridFrame flat(GridFrame frame) {
  frame.size[2] = 1;
  return frame;
}

}  // namespace

GridFrame slab_of(const GridFrame& whole, double z_m, double height_m) {
  constexpr double rounding = 1e-6;  // a border on the face of a cell does not touch the next
  const double bottom = (z_m - 0.5 * height_m - whole.origin_m.z()) / whole.resolution_m;
  const double top = (z_m + 0.5 * height_m - whole.origin_m.z()) / whole.resolution_m;
  const int low = static_cast<int>(std::floor(bottom + rounding));
  const int high = std::max(low + 1, static_cast<int>(std::ceil(top - rounding)));
  if (low < 0 || high > whole.size[2]) {
    throw ConfigError(fmt::format(
        "a vehicle {} m high at z = {} m leaves the scene's bounds, z = {} .. {} m; choose another depth or height",
        height_m, z_m, whole.origin_m.z(), whole.origin_m.z() + whole.resolution_m * whole.size[2]));
  }
  GridFrame slab = whole;
  slab.origin_m.z() += low * whole.resolution_m;
  slab.size[2] = high - low;
  return slab;
}

Slice slice_of(const LogOddsGrid& map) {
  const GridFrame& frame = map.frame();
  Slice slice{flat(frame), std::vector<ColumnState>(flat(frame).cells(), ColumnState::unknown)};
  for (int iy = 0; iy < frame.size[1]; ++iy) {
    for (int ix = 0; ix < frame.size[0]; ++ix) {
      int free = 0;
      int occupied = 0;
      for (int iz = 0; iz < frame.size[2]; ++iz) {
        const MilliLogOdds value = map.at({ix, iy, iz});
        free += value < 0 ? 1 : 0;
        occupied += value > 0 ? 1 : 0;
      }
      ColumnState& state = slice.columns[slice.index(ix, iy)];
      if (free == frame.size[2]) state = ColumnState::free;
      if (occupied > 0) state = ColumnState::occupied;
    }
  }
  return slice;
}

Slice slice_of(const OccupancyGrid& truth, const GridFrame& slab) {
  const GridFrame& whole = truth.frame;
  const int low = static_cast<int>(std::lround((slab.origin_m.z() - whole.origin_m.z()) / whole.resolution_m));
  Slice slice{flat(slab), std::vector<ColumnState>(flat(slab).cells(), ColumnState::free)};
  for (int iz = low; iz < low + slab.size[2]; ++iz) {
    for (int iy = 0; iy < slab.size[1]; ++iy) {
      for (int ix = 0; ix < slab.size[0]; ++ix) {
        if (truth.occupancy[whole.index(ix, iy, iz)] != static_cast<std::uint8_t>(Occupancy::free)) {
          slice.columns[slice.index(ix, iy)] = ColumnState::occupied;
        }
      }
    }
  }
  return slice;
}

double distance_to_column_m(const Slice& slice, int ix, int iy, double x_m, double y_m) {
  const double half = 0.5 * slice.frame.resolution_m;
  return std::hypot(std::max(0.0, std::abs(x_m - slice.x_m(ix)) - half),
                    std::max(0.0, std::abs(y_m - slice.y_m(iy)) - half));
}

ColumnMask columns_with_room(const Slice& slice, double clearance_m) {
  const auto [columns, rows, layers] = slice.frame.size;
  const double resolution_m = slice.frame.resolution_m;
  const int reach = static_cast<int>(std::ceil(clearance_m / resolution_m + 0.5));
  std::vector<std::array<int, 2>> too_near;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double gap_m =
          resolution_m * std::hypot(std::max(0.0, std::abs(dx) - 0.5), std::max(0.0, std::abs(dy) - 0.5));
      if (gap_m < clearance_m) too_near.push_back({dx, dy});
    }
  }
  ColumnMask room(slice.columns.size());
  for (std::size_t i = 0; i < room.size(); ++i) room[i] = slice.columns[i] == ColumnState::free ? 1 : 0;
  const auto is_free = [&](int ix, int iy) { return slice.at(ix, iy) == ColumnState::free; };
  // Only columns at the rim of the free ones can be the nearest that is not free; the frame is taken one column wider.
  for (int iy = -1; iy <= rows; ++iy) {
    for (int ix = -1; ix <= columns; ++ix) {
      if (is_free(ix, iy)) continue;
      bool rim = false;
      for (int dy = -1; dy <= 1 && !rim; ++dy) {
        for (int dx = -1; dx <= 1 && !rim; ++dx) rim = is_free(ix + dx, iy + dy);
      }
      if (!rim) continue;
      for (const auto& [dx, dy] : too_near) {
        if (slice.contains(ix + dx, iy + dy)) room[slice.index(ix + dx, iy + dy)] = 0;
      }
    }
  }
  return room;
}

}  // namespace ensonify
