#include "ensonify/output/map_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ensonify/core/error.hpp"
#include "ensonify/output/grid_nav2.hpp"
#include "ensonify/output/grid_npz.hpp"
#include "ensonify/output/grid_octomap.hpp"
#include "ensonify/output/grid_ply.hpp"

namespace ensonify {
namespace {

struct Format {
  const char* extension;
  /// Bytes a cell of what is built in memory. Trees, at worst one leaf a cell: a node of 16 bytes, its share of the
  /// tables of eight, what the heap adds, an eighth more for inner nodes, and the file.
  double bytes_a_cell;
  void (*write)(const LogOddsMap& map, const std::filesystem::path& path, std::optional<double> slice_z_m);
};

void write_nav2(const LogOddsMap& map, const std::filesystem::path& path, std::optional<double> slice_z_m) {
  const GridFrame& frame = map.frame;
  const double middle_m = frame.origin_m.z() + 0.5 * frame.size[2] * frame.resolution_m;
  write_grid_nav2(occupancy_of(map), path, slice_z_m.value_or(middle_m), true);
}

constexpr std::array formats{
    Format{".npz", 18, [](const LogOddsMap& map, const auto& path, auto) { write_map_npz(map, path); }},
    Format{".bt", 70,
           [](const LogOddsMap& map, const auto& path, auto) { write_grid_octomap(occupancy_of(map), path, true); }},
    Format{".ot", 80, [](const LogOddsMap& map, const auto& path, auto) { write_map_octomap(map, path); }},
    Format{".pgm", 3, write_nav2},
    Format{".ply", 32, [](const LogOddsMap& map, const auto& path, auto) { write_map_ply(map, path); }},
};

const Format& format_of(const std::filesystem::path& path) {
  const auto found = std::ranges::find(formats, path.extension().string(), &Format::extension);
  if (found != formats.end()) return *found;
  throw ConfigError(fmt::format("{}: no map format has the extension '{}'; use .npz, .bt, .ot, .pgm or .ply",
                                path.string(), path.extension().string()));
}

}  // namespace

void write_map(const LogOddsMap& map, const std::filesystem::path& path, std::optional<double> slice_z_m) {
  if (map.log_odds.size() != map.frame.cells()) {
    throw ConfigError(
        fmt::format("map with {} values for {} cells; it needs one a cell", map.log_odds.size(), map.frame.cells()));
  }
  if (!is_finite(map)) throw DataError(path.string() + ": the map holds NaN or infinity; unknown cells hold 0");
  format_of(path).write(map, path, slice_z_m);
}

LogOddsMap read_map(const std::filesystem::path& path) {
  if (path.extension() != ".npz") {
    throw ConfigError(fmt::format("{}: maps are read from .npz only; write one with that extension", path.string()));
  }
  return read_map_npz(path);
}

void require_map_format(const std::filesystem::path& path) { format_of(path); }

std::size_t bytes_to_write_map(const GridFrame& frame, const std::filesystem::path& path) {
  return static_cast<std::size_t>(format_of(path).bytes_a_cell * static_cast<double>(frame.cells()));
}

}  // namespace ensonify
