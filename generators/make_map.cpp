#include "ensonify/generators/make_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/map_box.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/output/map_files.hpp"

namespace ensonify {
namespace {

/// Of a cell at worst: the map in blocks and a ping's mark, then the dense map beside either the blocks or the file.
double bytes_a_cell(const std::filesystem::path& file) {
  constexpr double grid = 5.1, dense = 4;
  const GridFrame thousand{.origin_m = Vec3::Zero(), .resolution_m = 1, .size = {10, 10, 10}};
  return std::max(grid + dense, dense + static_cast<double>(bytes_to_write_map(thousand, file)) / 1000);
}

GridFrame frame_of(const Dataset& dataset, const MapRequest& request, const PlacePings& pings, bool& as_truth) {
  const bool elevations = std::holds_alternative<Oracle>(request.model);
  const MemoryRule rule{bytes_a_cell(request.file), bytes_of_pings(dataset, pings, elevations), request.memory_bytes};
  const auto truth = truth_of_place(dataset, pings.place);
  as_truth = truth.has_value();
  if (!truth) {
    if (!request.resolution_m) {
      throw ConfigError(fmt::format("{}: has no grids/{}.npz to take the resolution from; give --resolution",
                                    dataset.folder.string(), pings.place));
    }
    return frame_over(reach_of(pings, request.poses), *request.resolution_m, rule);
  }
  const double own_m = truth->frame.resolution_m;
  const double resolution_m = request.resolution_m.value_or(own_m);
  const bool same = std::abs(resolution_m / own_m - 1) < 1e-9;
  const GridFrame frame = frame_over(box_of_grid(truth->frame), resolution_m, rule);
  return same ? truth->frame : frame;
}

}  // namespace

MadeMap make_map(const Dataset& dataset, const MapRequest& request, const OnProgress& on_progress) {
  const PlacePings pings = pings_of_place(dataset, request.split, request.place, request.max_frames);
  const int total = static_cast<int>(pings.frames.size());
  MadeMap made{{}, pings.place, total, pings.ordered, false};
  const GridFrame frame = frame_of(dataset, request, pings, made.as_truth);
  int done = 0;
  const bool elevations = std::holds_alternative<Oracle>(request.model);
  const std::vector<PosedImage> images = read_pings(dataset, pings, request.filter, request.poses, elevations,
                                                    [&] { on_progress("filter", ++done, total); });
  LogOddsGrid grid(frame);
  MarkBox<Mark> scratch;
  done = 0;
  for (const PosedImage& image : images) {
    integrate_ping(image, request.threshold, request.model, grid, scratch);
    on_progress("map", ++done, total);
  }
  made.map = dense_map(grid);
  return made;
}

}  // namespace ensonify
