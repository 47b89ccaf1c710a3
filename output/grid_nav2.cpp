#include "ensonify/output/grid_nav2.hpp"

#include <fmt/format.h>

#include <string>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

enum Grey : unsigned char { occupied = 0, unknown = 205, free_space = 254 };

}  // namespace

void write_grid_nav2(const OccupancyGrid& grid, const std::filesystem::path& path, double z_m,
                     bool unobserved_is_unknown) {
  const GridFrame& frame = grid.frame;
  const double top_m = frame.origin_m.z() + frame.size[2] * frame.resolution_m;
  if (!(z_m >= frame.origin_m.z() && z_m <= top_m)) {
    throw ConfigError(fmt::format("slice at z = {} m lies outside the grid; choose one from {:.3f} to {:.3f} m", z_m,
                                  frame.origin_m.z(), top_m));
  }
  const int z = std::min(frame.cell_of({frame.origin_m.x(), frame.origin_m.y(), z_m})[2], frame.size[2] - 1);

  std::string image = fmt::format("P5\n{} {}\n255\n", frame.size[0], frame.size[1]);
  for (int y = frame.size[1] - 1; y >= 0; --y) {
    for (int x = 0; x < frame.size[0]; ++x) {
      const std::size_t cell = frame.index(x, y, z);
      Grey grey = grid.occupancy[cell] == static_cast<std::uint8_t>(Occupancy::free) ? free_space : occupied;
      if (unobserved_is_unknown && (grid.observable.empty() || !grid.observable[cell])) grey = unknown;
      image += static_cast<char>(grey);
    }
  }
  std::filesystem::path yaml = path;
  yaml.replace_extension(".yaml");
  write_file(path, image);
  // JSON's quoting is YAML's too; a file name may hold a colon or a hash.
  std::string name;
  for (const char c : path.filename().string()) name += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  write_file(yaml, fmt::format("image: \"{}\"\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\n"
                               "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                               name, frame.resolution_m, frame.origin_m.x(), frame.origin_m.y()));
}

}  // namespace ensonify
