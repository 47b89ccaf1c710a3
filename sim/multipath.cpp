#include "ensonify/sim/multipath.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/path_pairs.hpp"
#include "ensonify/sim/path_walks.hpp"

namespace ensonify {
namespace {

constexpr int columns = 256;
constexpr int usual_tiles = 1024;
constexpr double most_samples = 1024;

/// Half as many cells as tiles: the rest goes where the paths are.
PathTiles::Grid grid_for(int tiles) {
  PathTiles::Grid grid;
  while (2 * grid.cells() < tiles) (grid.columns == 8 * grid.rows ? grid.rows : grid.columns) *= 2;
  return grid;
}

}  // namespace

MultipathTracer::MultipathTracer(const RayScene& scene, const SonarModel& sonar, const Water& water)
    : MultipathTracer(scene, sonar, RayFan(sonar), water) {}

MultipathTracer::MultipathTracer(const RayScene& scene, const SonarModel& sonar, const RayFan& fan, const Water& water)
    : scene_(&scene), geometry_(sonar.geometry), fan_(sonar, fan, columns) {
  const double alpha = absorption_db_per_m(water, sonar.frequency_hz);
  for (int bin = 0; bin < geometry_.range_bins; ++bin) {
    row_loss_.push_back(static_cast<float>(std::pow(10.0, -0.2 * alpha * geometry_.bin_centre_m(bin))));
  }
}

Image2<float> MultipathTracer::trace(const Pose& T_world_sonar, int order, double samples) const {
  if (order != 2 && order != 3) throw ConfigError(fmt::format("multipath order {}: must be 2 or 3", order));
  if (!(samples > 0.0 && samples <= most_samples)) {
    throw ConfigError(fmt::format("multipath samples {}: must be over 0 and at most {}", samples, most_samples));
  }
  const FlushDenormals flush;
  const Eigen::Matrix3f R = T_world_sonar.linear().cast<float>();
  const RayAxes axes{T_world_sonar.translation().cast<float>(), R.col(0), R.col(1), R.col(2)};
  const RangeBins bins{static_cast<float>(geometry_.range_min_m), static_cast<float>(1.0 / geometry_.bin_size_m()),
                       geometry_.range_bins};
  // Half a path is no shorter than its longest leg.
  const auto reach_m = static_cast<float>(geometry_.range_max_m);
  const auto budget = static_cast<int>(std::lround(usual_tiles * std::sqrt(samples)));  // pairs grow as their square
  const PathTiles::Grid grid = grid_for(budget);
  // A few walks first, which only tell where paths are.
  const PathTiles equal(grid, std::vector<int>(static_cast<std::size_t>(grid.cells()), 0));
  const PathView pilot{*scene_, fan_, equal, axes, reach_m};
  const PathTiles tiles = PathTiles::for_energy(grid, walked_energy(pilot, PathHits(pilot)), budget);
  const PathView view{*scene_, fan_, tiles, axes, reach_m};
  const PathHits hits(view);
  PathImage energy(fan_.columns(), bins);
  add_joined_pairs(view, hits, energy);
  add_walked_paths(view, hits, order, energy);
  Image2<float> image = energy.over_beams(fan_.columns(), geometry_.beams());
  for (int bin = 0; bin < bins.count; ++bin) {
    for (float& cell : image.row(bin)) cell *= row_loss_[static_cast<std::size_t>(bin)];
  }
  return image;
}

}  // namespace ensonify
