#include "ensonify/generators/map_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"

namespace ensonify {

std::vector<MapPart> parts_of(const GridFrame& box, int margin, double bytes_a_cell, double limit_bytes) {
  constexpr int block = 8;  // maps lie in blocks of so many cells a side
  const auto padded = [](int n) { return 1.0 * block * ((n + block - 1) / block); };
  const double bytes_a_layer = bytes_a_cell * padded(box.size[1]) * padded(box.size[2]);
  const int layers = static_cast<int>(std::min(limit_bytes / bytes_a_layer, 1.0 * (1 << 30))) / block * block;
  const int width = layers >= padded(box.size[0]) ? box.size[0] : layers - 2 * margin;
  if (width < 1) {
    constexpr double gib = 1 << 30;
    throw ConfigError(fmt::format(
        "maps of {} x {} x {} cells at all thresholds need {:.3g} GiB even in slabs, and {:.3g} GiB of "
        "memory are left beside the images; take fewer frames with --max-frames",
        box.size[0], box.size[1], box.size[2], bytes_a_layer * (block + 2 * margin) / gib, limit_bytes / gib));
  }
  std::vector<MapPart> parts;
  for (int from = 0; from < box.size[0]; from += width) {
    const int to = std::min(from + width, box.size[0]);
    const int low = std::max(from - margin, 0);
    const int high = std::min(to + margin, box.size[0]);
    parts.push_back({part_of(box, {{low, 0, 0}, {high, box.size[1], box.size[2]}}),
                     {{from - low, 0, 0}, {to - low, box.size[1], box.size[2]}}});
  }
  return parts;
}

GridFrame part_of(const GridFrame& frame, const CellBox& box) {
  GridFrame part = frame;
  for (int a = 0; a < 3; ++a) {
    part.origin_m[a] += box.low[a] * frame.resolution_m;
    part.size[a] = box.high[a] - box.low[a];
  }
  return part;
}

OccupancyGrid cropped(const OccupancyGrid& grid, const CellBox& box) {
  OccupancyGrid part{part_of(grid.frame, box), {}, {}};
  for (int z = box.low[2]; z < box.high[2]; ++z) {
    for (int y = box.low[1]; y < box.high[1]; ++y) {
      const auto first = static_cast<std::ptrdiff_t>(grid.frame.index(box.low[0], y, z));
      const auto last = first + box.high[0] - box.low[0];
      part.occupancy.insert(part.occupancy.end(), grid.occupancy.begin() + first, grid.occupancy.begin() + last);
      part.observable.insert(part.observable.end(), grid.observable.begin() + first, grid.observable.begin() + last);
    }
  }
  return part;
}

CellBox observable_box(const OccupancyGrid& grid) {
  CellBox box;
  for (int z = 0; z < grid.frame.size[2]; ++z) {
    for (int y = 0; y < grid.frame.size[1]; ++y) {
      for (int x = 0; x < grid.frame.size[0]; ++x) {
        if (grid.observable[grid.frame.index(x, y, z)] != 0) box = hull(box, {{x, y, z}, {x + 1, y + 1, z + 1}});
      }
    }
  }
  return box;
}

CellBox hull(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  CellBox both;
  for (int i = 0; i < 3; ++i) {
    both.low[i] = std::min(a.low[i], b.low[i]);
    both.high[i] = std::max(a.high[i], b.high[i]);
  }
  return both;
}

}  // namespace ensonify
