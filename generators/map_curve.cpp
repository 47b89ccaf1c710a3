#include "ensonify/generators/map_curve.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/parallel.hpp"
#include "ensonify/evaluation/map_picture.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "ensonify/mapping/threshold_sweep.hpp"

namespace ensonify {
namespace {

/// The sweep, and of every thread one map: in blocks, dense, and as scores look at it.
double bytes_a_cell(const InverseModel& model, int thresholds, std::size_t tolerances) {
  const GridFrame block{.origin_m = Vec3::Zero(), .resolution_m = 1, .size = {block_side, block_side, block_side}};
  const double sweep = static_cast<double>(ThresholdSweep::bytes_at_worst(block, thresholds, model)) / block_cells;
  return sweep + tbb::this_task_arena::max_concurrency() * (10.0 + static_cast<double>(tolerances));
}

int cells_between(double from_m, double to_m, double resolution_m) {
  return static_cast<int>(std::lround((to_m - from_m) / resolution_m));
}

std::vector<std::uint8_t> scored_of(const MapTruth& truth, const GridFrame& part) {
  Cell first{};
  for (int a = 0; a < 3; ++a) {
    first[a] = cells_between(truth.frame.origin_m[a], part.origin_m[a], part.resolution_m);
  }
  std::vector<std::uint8_t> scored(part.cells());
  for (int z = 0; z < part.size[2]; ++z) {
    for (int y = 0; y < part.size[1]; ++y) {
      const auto from =
          truth.scored.begin() + static_cast<std::ptrdiff_t>(truth.frame.index(first[0], first[1] + y, first[2] + z));
      std::copy_n(from, part.size[0], scored.begin() + static_cast<std::ptrdiff_t>(part.index(0, y, z)));
    }
  }
  return scored;
}

/// Columns of the part's core into their place in the whole picture.
void paste(const Image2<std::uint8_t>& picture, const MapPart& part, int first, Image2<std::uint8_t>& whole) {
  for (int r = 0; r < whole.rows(); ++r) {
    for (int x = part.core.low[0]; x < part.core.high[0]; ++x) whole(r, first + x) = picture(r, x);
  }
}

}  // namespace

ScoredMaps score_maps(const std::vector<PosedImage>& pings, const InverseModel& model,
                      const std::vector<double>& thresholds, const MapTruth& truth, const GridFrame& box,
                      double limit_bytes) {
  const int n = static_cast<int>(thresholds.size());
  const Image2<std::uint8_t> blank(box.size[1], box.size[0]);
  ScoredMaps scored{std::vector<MapCounts>(thresholds.size()), {}};
  scored.seen.assign(thresholds.size(), {blank, blank});
  const int margin = truth.tolerances.empty() ? 0 : truth.tolerances.back();
  for (const MapPart& part : parts_of(box, margin, bytes_a_cell(model, n, truth.tolerances.size()), limit_bytes)) {
    ThresholdSweep sweep(part.frame, thresholds, model);
    for (const PosedImage& ping : pings) sweep.add(ping);
    const std::vector<std::uint8_t> is_scored = scored_of(truth, part.frame);
    const int first = cells_between(box.origin_m.x(), part.frame.origin_m.x(), box.resolution_m);
    parallel_for(n, [&](int t) {
      const auto i = static_cast<std::size_t>(t);
      const LogOddsMap map = dense_map(sweep.map_at(t));
      scored.counts[i] += count_map(map, truth, part.core);
      paste(seen_from_above(map, is_scored, MapSide::free), part, first, scored.seen[i][0]);
      paste(seen_from_above(map, is_scored, MapSide::occupied), part, first, scored.seen[i][1]);
    });
  }
  return scored;
}

}  // namespace ensonify
