#include "ensonify/output/grid_ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "ensonify/output/atomic_file.hpp"

namespace ensonify {

void write_grid_ply(const OccupancyGrid& grid, const std::filesystem::path& path) {
  const GridFrame& frame = grid.frame;
  constexpr auto surface = static_cast<std::uint8_t>(Occupancy::surface);
  const auto points = std::count(grid.occupancy.begin(), grid.occupancy.end(), surface);
  std::string file = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment cell centres, metres, world ENU; resolution {} m\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar occupancy\nproperty uchar observable\nend_header\n",
      frame.resolution_m, points);
  for (int z = 0; z < frame.size[2]; ++z) {
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = 0; x < frame.size[0]; ++x) {
        const std::size_t cell = frame.index(x, y, z);
        if (grid.occupancy[cell] != surface) continue;
        const Eigen::Vector3f centre = frame.centre_m(x, y, z).cast<float>();
        char bytes[14];
        std::memcpy(bytes, centre.data(), 12);
        bytes[12] = static_cast<char>(surface);
        bytes[13] = static_cast<char>(grid.observable.empty() ? 0 : grid.observable[cell]);
        file.append(bytes, sizeof bytes);
      }
    }
  }
  write_file(path, file);
}

}  // namespace ensonify
