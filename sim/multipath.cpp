#include "ensonify/sim/multipath.hpp"

#include <cmath>

#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/path_pairs.hpp"
#include "ensonify/sim/path_walks.hpp"

namespace ensonify {

MultipathTracer::MultipathTracer(const RayScene& scene, const SonarModel& sonar, const Water& water, int density)
    : scene_(&scene), geometry_(sonar.geometry), fan_(sonar, density) {
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
  const PathHits hits(*scene_, fan_, axes, reach_m);
  PathImage energy(fan_.columns(), bins);
  add_joined_pairs(*scene_, hits, axes, energy);
  add_walked_paths(*scene_, fan_, hits, axes, order, reach_m, energy);
  Image2<float> image = energy.over_beams(fan_.columns(), geometry_.beams());
  for (int bin = 0; bin < bins.count; ++bin) {
    for (float& cell : image.row(bin)) cell *= row_loss_[static_cast<std::size_t>(bin)];
  }
  return image;
}

}  // namespace ensonify
