#include "ensonify/sim/multipath.hpp"

#include <cmath>

#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/path_pairs.hpp"
#include "ensonify/sim/path_walks.hpp"

namespace ensonify {
namespace {

constexpr int default_columns = 256;
constexpr int default_tiles = 512;
/// The rest goes where the paths are.
constexpr double default_cells_a_tile = 0.5;

}  // namespace

MultipathTracer::MultipathTracer(const RayScene& scene, const SonarModel& sonar, const Water& water, int density)
    : MultipathTracer(scene, sonar, RayFan(sonar), water, density) {}

MultipathTracer::MultipathTracer(const RayScene& scene, const SonarModel& sonar, const RayFan& fan, const Water& water,
                                 int density)
    : scene_(&scene), geometry_(sonar.geometry), fan_(sonar, fan, density > 1 ? 2 * default_columns : default_columns) {
  const double points = std::sqrt(static_cast<double>(density));  // pairs grow as their square
  tiles_ = static_cast<int>(std::lround(default_tiles * points));
  while (grid_.cells() < default_cells_a_tile * tiles_)
    (grid_.columns == 8 * grid_.rows ? grid_.rows : grid_.columns) *= 2;
  const double alpha = absorption_db_per_m(water, sonar.frequency_hz);
  for (int bin = 0; bin < geometry_.range_bins; ++bin) {
    row_loss_.push_back(static_cast<float>(std::pow(10.0, -0.2 * alpha * geometry_.bin_centre_m(bin))));
  }
}

Image2<float> MultipathTracer::trace(const Pose& T_world_sonar, int order) const {
  const FlushDenormals flush;
  const Eigen::Matrix3f R = T_world_sonar.linear().cast<float>();
  const RayAxes axes{T_world_sonar.translation().cast<float>(), R.col(0), R.col(1), R.col(2)};
  const RangeBins bins{static_cast<float>(geometry_.range_min_m), static_cast<float>(1.0 / geometry_.bin_size_m()),
                       geometry_.range_bins};
  // Half a path is no shorter than its longest leg.
  const auto reach_m = static_cast<float>(geometry_.range_max_m);
  // A few walks first, which only tell where paths are.
  const PathTiles equal(grid_, std::vector<int>(static_cast<std::size_t>(grid_.cells()), 0));
  const PathView pilot{*scene_, fan_, equal, axes, reach_m};
  const PathTiles tiles = PathTiles::for_energy(grid_, walked_energy(pilot, PathHits(pilot)), tiles_);
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
