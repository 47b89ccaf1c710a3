#include "ensonify/sim/trace_ping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ensonify/sim/beam_echo.hpp"
#include "ensonify/sim/flush_denormals.hpp"

namespace ensonify {
namespace {

/// Beams finished together, so that whole cache lines of the row-major images are written.
constexpr int block_beams = 16;
/// Rays reach a little beyond the window, since a footprint ends at its neighbour's hit.
constexpr float reach_factor = 1.2f;

void keep_first_hits(const RayColumn& rays, int column, float range_max_m, Image2<float>& first_hit_m) {
  for (int i = 0; i < rays.rays; ++i) {
    const float r = rays.range_m[i + 1];
    first_hit_m(i, column) = r < range_max_m ? r : std::numeric_limits<float>::infinity();
  }
}

/// A block of beams, a beam a row, into the columns of an image from `first` on.
void write_columns(const Image2<float>& block, int beams, int first, Image2<float>& image) {
  for (int bin = 0; bin < image.rows(); ++bin) {
    float* __restrict out = &image(bin, first);
    const float* __restrict in = &block(0, bin);
    for (int b = 0; b < beams; ++b) out[b] = in[static_cast<std::ptrdiff_t>(b) * block.columns()];
  }
}

/// Moments of energy become means of what was weighted with it; 0 where there is none.
void divide(std::span<float> moment, std::span<const float> energy) {
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] = energy[i] > 0.0f ? moment[i] / energy[i] : 0.0f;
}

}  // namespace

PingTracer::PingTracer(const RayScene& scene, const SonarModel& sonar, const Water& water)
    : scene_(&scene),
      geometry_(sonar.geometry),
      sound_speed_mps_(sound_speed_mps(water)),
      fan_(sonar),
      multipath_(scene, sonar, fan_, water) {
  const double alpha = absorption_db_per_m(water, sonar.frequency_hz);
  for (int bin = 0; bin < geometry_.range_bins; ++bin) {
    const double r = geometry_.bin_centre_m(bin);
    row_loss_.push_back(static_cast<float>(std::pow(10.0, -0.2 * alpha * r) / (r * r)));
  }
}

PingTruth PingTracer::empty_truth() const {
  PingTruth truth;
  truth.first_hit_range_m = Image2<float>(fan_.elevation_rays, static_cast<int>(fan_.columns.size()));
  for (std::size_t c = 0; c < fan_.columns.size(); ++c) {
    truth.ray_azimuth_rad.push_back(fan_.columns[c].azimuth_rad);
    truth.lowest_elevation_rad.push_back(fan_.rows_of(static_cast<int>(c)).elevation_rad.front());
  }
  truth.elevation_step_rad = fan_.rows[0].elevation_rad[1] - fan_.rows[0].elevation_rad[0];
  truth.shadow_start_bin.resize(static_cast<std::size_t>(geometry_.beams()));
  return truth;
}

Ping PingTracer::trace(const Pose& T_world_sonar, const TraceOptions& options) const {
  const FlushDenormals flush;
  const int beams = geometry_.beams();
  const auto range_max_m = static_cast<float>(geometry_.range_max_m);
  const RangeBins bins{static_cast<float>(geometry_.range_min_m), static_cast<float>(1.0 / geometry_.bin_size_m()),
                       geometry_.range_bins};
  const Eigen::Matrix3f R = T_world_sonar.linear().cast<float>();
  const RayAxes axes{T_world_sonar.translation().cast<float>(), R.col(0), R.col(1), R.col(2)};

  Ping ping{{Image2<float>(bins.count, beams), {}, {}}, empty_truth()};
  if (options.multipath_order > 1)
    ping.echo.multipath = multipath_.trace(T_world_sonar, options.multipath_order, options.multipath_samples);
  if (options.elevation) ping.echo.elevation_rad = Image2<float>(bins.count, beams);
  std::optional<CellTruth> cells;
  if (options.cell_truth) cells.emplace(bins.count, beams, ping.truth);
  RayColumn rays(fan_.elevation_rays);
  ShadowCount shadow(bins.count);
  Image2<float> energy(block_beams, bins.count);
  Image2<float> moment(options.elevation ? block_beams : 0, bins.count);

  for (int block = 0; block < beams; block += block_beams) {
    const int in_block = std::min(block_beams, beams - block);
    std::fill(energy.pixels().begin(), energy.pixels().end(), 0.0f);
    std::fill(moment.pixels().begin(), moment.pixels().end(), 0.0f);
    for (int b = 0; b < in_block; ++b) {
      const int beam = block + b;
      shadow.clear();
      for (int c = beam * fan_.rays_per_beam; c < (beam + 1) * fan_.rays_per_beam; ++c) {
        const RayFan::Column& column = fan_.columns[static_cast<std::size_t>(c)];
        const RayFan::Rows& rows = fan_.rows_of(c);
        cast_column(*scene_, rows, column, axes, reach_factor * range_max_m, rays);
        shade_column(*scene_, rows, column, rays);
        if (options.elevation)
          add_energy_at_elevation(rays, rows, bins, energy.row(b).data(), moment.row(b).data());
        else
          add_energy(rays, bins, energy.row(b).data());
        shadow.add(rays, rows, bins);
        keep_first_hits(rays, c, range_max_m, ping.truth.first_hit_range_m);
        if (cells) cells->add(rays, rows, bins, *scene_, beam);
      }
      ping.truth.shadow_start_bin[beam] = shadow.start_bin();
    }
    for (int b = 0; b < in_block; ++b) {
      const std::span<float> of_beam = energy.row(b);
      if (options.elevation) divide(moment.row(b), of_beam);
      for (std::size_t bin = 0; bin < of_beam.size(); ++bin) of_beam[bin] *= row_loss_[bin];
    }
    write_columns(energy, in_block, block, ping.echo.direct);
    if (options.elevation) write_columns(moment, in_block, block, ping.echo.elevation_rad);
  }
  if (!options.motion.still()) {
    ping.echo = receive_in_motion(ping.echo, geometry_, options.motion, sound_speed_mps_);
  }
  return ping;
}

}  // namespace ensonify
