#include "ensonify/output/grid_files.hpp"

#include <fmt/format.h>

#include <string>

#include "ensonify/core/error.hpp"
#include "ensonify/output/grid_nav2.hpp"
#include "ensonify/output/grid_npz.hpp"
#include "ensonify/output/grid_octomap.hpp"
#include "ensonify/output/grid_ply.hpp"
#include "ensonify/output/grid_vdb.hpp"

namespace ensonify {

void write_grid(const OccupancyGrid& grid, const std::filesystem::path& path, const GridFileOptions& options) {
  const std::size_t cells = grid.frame.cells();
  if (grid.occupancy.size() != cells || (!grid.observable.empty() && grid.observable.size() != cells)) {
    throw ConfigError(fmt::format("occupancy grid has {} cells of occupancy and {} of observable, its frame says {}",
                                  grid.occupancy.size(), grid.observable.size(), cells));
  }
  const std::string extension = path.extension().string();
  if (extension == ".npz") return write_grid_npz(grid, path);
  if (extension == ".bt") return write_grid_octomap(grid, path, options.unobserved_is_unknown);
  if (extension == ".ply") return write_grid_ply(grid, path);
  if (extension == ".vdb") return write_grid_vdb(grid, path);
  if (extension == ".pgm") {
    const GridFrame& frame = grid.frame;
    const double middle_m = frame.origin_m.z() + 0.5 * frame.size[2] * frame.resolution_m;
    return write_grid_nav2(grid, path, options.slice_z_m.value_or(middle_m), options.unobserved_is_unknown);
  }
  throw ConfigError(fmt::format("{}: no grid format has the extension '{}'; use .npz, .bt, .pgm, .ply or .vdb",
                                path.string(), extension));
}

OccupancyGrid read_grid(const std::filesystem::path& path) {
  if (path.extension() != ".npz") {
    throw ConfigError(
        fmt::format("{}: occupancy grids are read from .npz only; write one with that extension", path.string()));
  }
  return read_grid_npz(path);
}

}  // namespace ensonify
