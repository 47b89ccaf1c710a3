#include "ensonify/sim/trace_ping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensonify/sim/flush_denormals.hpp"
#include "ensonify/sim/ray_column.hpp"

namespace ensonify {
namespace {

/// Beams finished together, so that whole cache lines of the row-major images are written.
constexpr int block_beams = 16;
/// Rays reach a little beyond the window: a footprint ends at its neighbour's hit.
constexpr float reach_factor = 1.2f;

/// Relative slope of a Lambert plane's energy over range, r^-3.
constexpr float lambert_slope = -3.0f;

/// Calls give(bin, share) for the range bins that an interval [near, far) of bin coordinates covers; the shares of all
/// bins sum to `energy` where the interval lies inside [0, bins). Density falls linearly, by `slope` in total.
template <typename Give>
void spread(float near, float far, float slope, float energy, int bins, const Give& give) {
  if (far <= 0.0f || near >= static_cast<float>(bins)) return;
  const int first = std::max(static_cast<int>(std::floor(near)), 0);
  const int last = std::min(static_cast<int>(far), bins - 1);
  const float width = far - near;
  if (first >= last && near >= 0.0f && far <= static_cast<float>(bins)) {
    give(first, energy);
    return;
  }
  const float inverse_width = 1.0f / width;
  const auto share_below = [&](float x) {
    const float u = std::clamp((x - near) * inverse_width, 0.0f, 1.0f);
    return u + 0.5f * slope * (u * u - u);
  };
  float below = near < 0.0f ? share_below(0.0f) : 0.0f;
  for (int bin = first; bin <= last; ++bin) {
    const float up_to = share_below(static_cast<float>(bin + 1));
    give(bin, energy * (up_to - below));
    below = up_to;
  }
}

/// First bin before which at least half of `rays` have ended.
int shadow_start(const std::vector<int>& hits_in_bin, int hits_before_window, int rays) {
  int ended = hits_before_window;
  const int bins = static_cast<int>(hits_in_bin.size());
  for (int bin = 0; bin < bins; ++bin) {
    if (2 * ended >= rays) return bin;
    ended += hits_in_bin[bin];
  }
  return bins;
}

}  // namespace

PingTracer::PingTracer(const RayScene& scene, const SonarModel& sonar, const Water& water)
    : scene_(&scene), geometry_(sonar.geometry), fan_(sonar) {
  const double alpha = absorption_db_per_m(water, sonar.frequency_hz);
  for (int bin = 0; bin < geometry_.range_bins; ++bin) {
    const double r = geometry_.bin_centre_m(bin);
    row_loss_.push_back(static_cast<float>(std::pow(10.0, -0.2 * alpha * r) / (r * r)));
  }
}

Ping PingTracer::trace(const Pose& T_world_sonar, bool cell_truth) const {
  const FlushDenormals flush;
  const int bins = geometry_.range_bins;
  const int beams = geometry_.beams();
  const int rays = fan_.elevation_rays;
  const auto start_m = static_cast<float>(geometry_.range_min_m);
  const auto reach_m = static_cast<float>(geometry_.range_max_m);
  const auto bins_per_m = static_cast<float>(1.0 / geometry_.bin_size_m());
  const Eigen::Matrix3f R = T_world_sonar.linear().cast<float>();
  const RayAxes axes{T_world_sonar.translation().cast<float>(), R.col(0), R.col(1), R.col(2)};

  Ping ping;
  ping.echo.direct = Image2<float>(bins, beams);
  PingTruth& truth = ping.truth;
  truth.first_hit_range_m = Image2<float>(rays, static_cast<int>(fan_.columns.size()));
  truth.ray_elevation_rad = fan_.elevation_rad;
  for (const RayFan::Column& column : fan_.columns) truth.ray_azimuth_rad.push_back(column.azimuth_rad);
  truth.shadow_start_bin.assign(static_cast<std::size_t>(beams), bins);
  Image2<float> strongest;
  if (cell_truth) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    truth.elevation_min_rad = truth.elevation_max_rad = truth.elevation_strongest_rad = truth.incidence_rad =
        Image2<float>(bins, beams, nan);
    truth.instance = Image2<std::int32_t>(bins, beams, -1);
    strongest = Image2<float>(bins, beams, 0.0f);
  }

  RayColumn column_rays(rays);
  Image2<float> energy(block_beams, bins);
  std::vector<int> hits_in_bin(static_cast<std::size_t>(bins));

  for (int block = 0; block < beams; block += block_beams) {
    const int in_block = std::min(block_beams, beams - block);
    std::fill(energy.pixels().begin(), energy.pixels().end(), 0.0f);
    for (int b = 0; b < in_block; ++b) {
      const int beam = block + b;
      float* beam_energy = energy.row(b).data();
      std::fill(hits_in_bin.begin(), hits_in_bin.end(), 0);
      int hits_before_window = 0;
      for (int k = 0; k < fan_.rays_per_beam; ++k) {
        const int c = beam * fan_.rays_per_beam + k;
        const RayFan::Column& column = fan_.columns[static_cast<std::size_t>(c)];
        cast_column(*scene_, fan_, axes, column, reach_factor * reach_m, column_rays);
        shade_column(*scene_, fan_, column, column_rays);

        for (int i = 0; i < rays; ++i) {
          const float r = column_rays.range_m[i + 1];
          truth.first_hit_range_m(i, c) = r < reach_m ? r : std::numeric_limits<float>::infinity();
          if (!(r < reach_factor * reach_m)) continue;
          const float near = (column_rays.near_m[i] - start_m) * bins_per_m;
          const float far = (column_rays.far_m[i] - start_m) * bins_per_m;
          const float slope =
              std::max(lambert_slope * (column_rays.far_m[i] - column_rays.near_m[i]) / r, -1.8f);
          spread(near, far, slope, column_rays.energy[i], bins,
                 [&](int bin, float share) { beam_energy[bin] += share; });
          if (i >= fan_.first_nominal_row && i < fan_.last_nominal_row && r < reach_m) {
            const int bin = static_cast<int>((r - start_m) * bins_per_m);
            if (r < start_m) ++hits_before_window;
            else if (bin < bins) ++hits_in_bin[bin];
          }
          if (!cell_truth) continue;
          spread(near, far, slope, column_rays.energy[i], bins, [&](int bin, float share) {
            const float phi = fan_.elevation_rad[i];
            float& lowest = truth.elevation_min_rad(bin, beam);
            float& highest = truth.elevation_max_rad(bin, beam);
            if (!(lowest <= phi)) lowest = phi;
            if (!(highest >= phi)) highest = phi;
            if (share <= strongest(bin, beam)) return;
            strongest(bin, beam) = share;
            truth.elevation_strongest_rad(bin, beam) = phi;
            truth.incidence_rad(bin, beam) = std::acos(column_rays.cos_incidence[i]);
            truth.instance(bin, beam) = scene_->surfaces()[column_rays.surface[i]].instance;
          });
        }
      }
      const int nominal_rays = (fan_.last_nominal_row - fan_.first_nominal_row) * fan_.rays_per_beam;
      truth.shadow_start_bin[beam] = shadow_start(hits_in_bin, hits_before_window, nominal_rays);
    }
    for (int bin = 0; bin < bins; ++bin) {
      const float loss = row_loss_[bin];
      float* out = &ping.echo.direct(bin, block);
      for (int b = 0; b < in_block; ++b) out[b] = loss * energy(b, bin);
    }
  }
  return ping;
}

}  // namespace ensonify
