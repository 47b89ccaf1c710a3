#include "ensonify/output/grid_ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

std::string header(const GridFrame& frame, std::ptrdiff_t points, const char* remark, const char* properties) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment cell centres, metres, world ENU; resolution {} m{}\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}end_header\n",
      frame.resolution_m, remark, points, properties);
}

/// Appends the centres of cells for which is(cell) holds, each followed by what more(cell) appends.
template <typename Is, typename More>
void append_points(std::string& file, const GridFrame& frame, const Is& is, const More& more) {
  for (int z = 0; z < frame.size[2]; ++z) {
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = 0; x < frame.size[0]; ++x) {
        const std::size_t cell = frame.index(x, y, z);
        if (!is(cell)) continue;
        const Eigen::Vector3f centre = frame.centre_m(x, y, z).cast<float>();
        char bytes[12];
        std::memcpy(bytes, centre.data(), sizeof bytes);
        file.append(bytes, sizeof bytes);
        more(cell);
      }
    }
  }
}

}  // namespace

void write_grid_ply(const OccupancyGrid& grid, const std::filesystem::path& path) {
  constexpr auto surface = static_cast<std::uint8_t>(Occupancy::surface);
  const auto points = std::count(grid.occupancy.begin(), grid.occupancy.end(), surface);
  std::string file = header(grid.frame, points, "", "property uchar occupancy\nproperty uchar observable\n");
  append_points(
      file, grid.frame, [&](std::size_t cell) { return grid.occupancy[cell] == surface; },
      [&](std::size_t cell) {
        file += static_cast<char>(surface);
        file += static_cast<char>(grid.observable.empty() ? 0 : grid.observable[cell]);
      });
  write_file(path, file);
}

void write_map_ply(const LogOddsMap& map, const std::filesystem::path& path) {
  const auto points = std::count_if(map.log_odds.begin(), map.log_odds.end(), [](float v) { return v > 0; });
  std::string file = header(map.frame, points, "; log_odds natural, positive occupied", "property float log_odds\n");
  append_points(
      file, map.frame, [&](std::size_t cell) { return map.log_odds[cell] > 0; },
      [&](std::size_t cell) {
        char bytes[sizeof(float)];
        std::memcpy(bytes, &map.log_odds[cell], sizeof bytes);
        file.append(bytes, sizeof bytes);
      });
  write_file(path, file);
}

}  // namespace ensonify
