#include "ensonify/sim/beam_echo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ensonify {
namespace {

/// Calls give(bin, energy) for the range bins that a ray's footprint covers. Density changes linearly over it; what
/// lies outside of the window is lost.
template <typename Give>
inline void spread(const RayColumn& rays, int i, const RangeBins& bins, const Give& give) {
  const float near = bins.place_of(rays.near_m[i]);
  const float far = bins.place_of(rays.far_m[i]);
  const auto count = static_cast<float>(bins.count);
  if (!(far > 0.0f && near < count)) return;
  const int first = static_cast<int>(std::max(near, 0.0f));
  const int last = std::min(static_cast<int>(far), bins.count - 1);
  const float energy = rays.energy[i];
  if (first == last && near >= 0.0f && far <= count) {
    give(first, energy);
    return;
  }
  const float inverse_width = 1.0f / (far - near);
  const float slope = rays.slope[i];
  const auto share_below = [&](float x) {
    const float u = std::min((x - near) * inverse_width, 1.0f);
    return u + 0.5f * slope * (u * u - u);
  };
  float below = near < 0.0f ? share_below(0.0f) : 0.0f;
  for (int bin = first; bin <= last; ++bin) {
    const float up_to = share_below(static_cast<float>(bin + 1));
    give(bin, energy * (up_to - below));
    below = up_to;
  }
}

/// The rays that stand for the nominal elevation arc: [first, last). Where they stand so far apart that none lies in
/// it, the one nearest to the axis does.
struct Arc {
  int first, last;
};
Arc nominal_arc(const RayFan::Rows& rows) {
  if (rows.first_nominal < rows.last_nominal) return {rows.first_nominal, rows.last_nominal};
  const auto& phi = rows.elevation_rad;
  const auto nearest =
      std::min_element(phi.begin(), phi.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
  const auto i = static_cast<int>(nearest - phi.begin());
  return {i, i + 1};
}

}  // namespace

void add_energy(const RayColumn& rays, const RangeBins& bins, float* energy) {
  for (int i = 0; i < rays.rays; ++i) {
    spread(rays, i, bins, [&](int bin, float share) { energy[bin] += share; });
  }
}

void add_energy_at_elevation(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins, float* energy,
                             float* moment) {
  const float step = rows.elevation_rad[1] - rows.elevation_rad[0];
  for (int i = 0; i < rays.rays; ++i) {
    const float near = bins.place_of(rays.near_m[i]);
    const float extent = bins.place_of(rays.far_m[i]) - near;
    // On the tangent plane n . (r d) stays, so dr / dphi has the sign of this product.
    const float receding = rays.slant[i] * (rays.normal_forward[i] * rows.sine[i] - rays.normal_up[i] * rows.cosine[i]);
    const float rise = receding > 0.0f ? step : -step;
    const float per_bin = extent > 1.0f ? rise / extent : 0.0f;
    const float start = rows.elevation_rad[i] - (extent > 1.0f ? 0.5f * rise + (near - 0.5f) * per_bin : 0.0f);
    spread(rays, i, bins, [&](int bin, float share) {
      energy[bin] += share;
      moment[bin] += share * (start + per_bin * static_cast<float>(bin));
    });
  }
}

void ShadowCount::clear() {
  std::fill(hits_in_bin_.begin(), hits_in_bin_.end(), 0);
  hits_before_window_ = 0;
  rays_ = 0;
}

void ShadowCount::add(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins) {
  const Arc arc = nominal_arc(rows);
  rays_ += arc.last - arc.first;
  for (int i = arc.first; i < arc.last; ++i) {
    const float place = bins.place_of(rays.range_m[i + 1]);
    if (place < 0.0f)
      ++hits_before_window_;
    else if (place < static_cast<float>(bins.count))
      ++hits_in_bin_[static_cast<std::size_t>(place)];
  }
}

int ShadowCount::start_bin() const {
  const int bins = static_cast<int>(hits_in_bin_.size());
  int ended = hits_before_window_;
  for (int bin = 0; bin < bins; ++bin) {
    if (2 * ended >= rays_) return bin;
    ended += hits_in_bin_[bin];
  }
  return bins;
}

CellTruth::CellTruth(int bins, int beams, PingTruth& truth) : truth_(&truth), strongest_(bins, beams) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  truth.elevation_min_rad = Image2<float>(bins, beams, nan);
  truth.elevation_max_rad = Image2<float>(bins, beams, nan);
  truth.elevation_strongest_rad = Image2<float>(bins, beams, nan);
  truth.incidence_rad = Image2<float>(bins, beams, nan);
  truth.instance = Image2<std::int32_t>(bins, beams, -1);
}

void CellTruth::add(const RayColumn& rays, const RayFan::Rows& rows, const RangeBins& bins, const RayScene& scene,
                    int beam) {
  for (int i = 0; i < rays.rays; ++i) {
    const float phi = rows.elevation_rad[i];
    spread(rays, i, bins, [&](int bin, float share) {
      float& lowest = truth_->elevation_min_rad(bin, beam);
      float& highest = truth_->elevation_max_rad(bin, beam);
      if (!(lowest <= phi)) lowest = phi;
      if (!(highest >= phi)) highest = phi;
      if (share <= strongest_(bin, beam)) return;
      strongest_(bin, beam) = share;
      truth_->elevation_strongest_rad(bin, beam) = phi;
      truth_->incidence_rad(bin, beam) = std::acos(rays.cos_incidence[i]);
      truth_->instance(bin, beam) = scene.surfaces()[rays.surface[i]].instance;
    });
  }
}

}  // namespace ensonify
