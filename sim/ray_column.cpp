#include "ensonify/sim/ray_column.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ensonify {
namespace {

constexpr int packet = 8;
constexpr float infinity = std::numeric_limits<float>::infinity();
/// Footprints across azimuth are cut where the surface is met at less than about 7 degrees.
constexpr float steepest_azimuth_slope = 8.0f;
/// Exponent of range in the energy that a Lambert plane sends back a metre of range, before r^-2 and absorption:
/// cos i and d phi / d r fall as r^-1 and r^-2.
constexpr float lambert_exponent = -3.0f;
/// Keeps the density of a very long footprint positive.
constexpr float steepest_slope = 1.8f;

// By value: std::min and std::max return references, which keep loops from becoming vector code.
constexpr float least(float a, float b) { return a < b ? a : b; }
constexpr float most(float a, float b) { return a > b ? a : b; }

// The two loops below become vector code, because their arrays are parameters that are said not to overlap.

/// What each ray's surface sends back (see `shade_column`).
void scatter(int count, const float* __restrict slant, const float* __restrict inverse_norm,
             const float* __restrict range, const int* __restrict material, const float* __restrict gain,
             float column_gain, const float* __restrict table, float* __restrict cos_incidence,
             float* __restrict energy) {
  for (int i = 0; i < count; ++i) {
    const float cosine = least(std::abs(slant[i]) * inverse_norm[i], 1.0f);
    const float place = std::sqrt(1.0f - cosine) * static_cast<float>(RayScene::scatter_steps);
    const int step = static_cast<int>(place);
    const int entry = material[i] * RayScene::scatter_stride + step;
    const float sent = table[entry] + (place - static_cast<float>(step)) * (table[entry + 1] - table[entry]);
    cos_incidence[i] = cosine;
    energy[i] = sent * gain[i] * (range[i] < infinity ? column_gain : 0.0f);
  }
}

/// Ranges that each ray's footprint covers, and how its energy falls over them. On the tangent plane n . (r d) is
/// constant, so r at a border is r n.d / n.d_border; a plane that the border misses gives a negative or infinite r,
/// taken as infinity.
void spread_footprints(int count, const float* __restrict range, const float* __restrict slant,
                       const float* __restrict ahead, const float* __restrict up, const float* __restrict left,
                       const float* __restrict cosine, const float* __restrict edge_cosine,
                       const float* __restrict edge_sine, const float* __restrict gain_slope, float width_rad,
                       float* __restrict near_m, float* __restrict far_m, float* __restrict slope) {
  for (int i = 0; i < count; ++i) {
    const float r = range[i];
    const float below = range[i - 1];
    const float above = range[i + 1];
    const float at_lower = r * (slant[i] / (ahead[i] * edge_cosine[i] + up[i] * edge_sine[i]));
    const float at_upper = r * (slant[i] / (ahead[i] * edge_cosine[i + 1] + up[i] * edge_sine[i + 1]));
    float lower = at_lower > 0.0f ? at_lower : infinity;
    float upper = at_upper > 0.0f ? at_upper : infinity;
    lower = least(most(lower, least(r, below)), most(r, below));
    upper = least(most(upper, least(r, above)), most(r, above));
    lower = lower < infinity ? lower : r;
    upper = upper < infinity ? upper : r;
    // Where a surface ends, the tangent plane would go on: no farther than on the side where it is known to.
    const float known_below = below < infinity ? std::abs(lower - r) : infinity;
    const float known_above = above < infinity ? std::abs(upper - r) : infinity;
    lower = below < infinity ? lower : least(most(lower, r - known_above), r + known_above);
    upper = above < infinity ? upper : least(most(upper, r - known_below), r + known_below);
    const float tilt = std::abs(left[i]) / most(std::abs(slant[i]), 1e-20f);
    const float across = r * cosine[i] * width_rad * least(tilt * cosine[i], steepest_azimuth_slope);
    const float along = upper - lower;
    const float half = 0.5f * std::sqrt(along * along + across * across);
    const float middle = 0.5f * (lower + upper);
    near_m[i] = middle - half;
    far_m[i] = middle + half;
    const float falling = lambert_exponent * (2.0f * half / r) + gain_slope[i] * (along / most(2.0f * half, 1e-20f));
    slope[i] = least(most(falling, -steepest_slope), steepest_slope);
  }
}

}  // namespace

RayColumn::RayColumn(int count)
    : rays(count),
      range_m(static_cast<std::size_t>(count) + 2, infinity),
      normal_forward(static_cast<std::size_t>(count)),
      normal_up(static_cast<std::size_t>(count)),
      normal_left(static_cast<std::size_t>(count)),
      inverse_norm(static_cast<std::size_t>(count)),
      surface(static_cast<std::size_t>(count)),
      material(static_cast<std::size_t>(count)),
      slant(static_cast<std::size_t>(count)),
      energy(static_cast<std::size_t>(count)),
      cos_incidence(static_cast<std::size_t>(count)),
      near_m(static_cast<std::size_t>(count)),
      far_m(static_cast<std::size_t>(count)),
      slope(static_cast<std::size_t>(count)) {}

void cast_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, const RayAxes& axes,
                 float reach_m, RayColumn& rays) {
  const Eigen::Vector3f ahead = column.cosine * axes.forward + column.sine * axes.left;
  const Eigen::Vector3f aside = column.cosine * axes.left - column.sine * axes.forward;
  const Eigen::Vector3f& up = axes.up;
  const RayScene::Surface* surfaces = scene.surfaces().data();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) static constexpr int all_valid[packet] = {-1, -1, -1, -1, -1, -1, -1, -1};

  for (int first = 0; first < rays.rays; first += packet) {
    alignas(32) RTCRayHit8 hit;
    const float* cos_phi = rows.cosine.data() + first;
    const float* sin_phi = rows.sine.data() + first;
    for (int l = 0; l < packet; ++l) {
      hit.ray.org_x[l] = axes.origin.x();
      hit.ray.org_y[l] = axes.origin.y();
      hit.ray.org_z[l] = axes.origin.z();
      hit.ray.dir_x[l] = cos_phi[l] * ahead.x() + sin_phi[l] * up.x();
      hit.ray.dir_y[l] = cos_phi[l] * ahead.y() + sin_phi[l] * up.y();
      hit.ray.dir_z[l] = cos_phi[l] * ahead.z() + sin_phi[l] * up.z();
      hit.ray.tnear[l] = 0.0f;
      hit.ray.tfar[l] = reach_m;
      hit.ray.time[l] = 0.0f;
      hit.ray.mask[l] = ~0u;
      hit.ray.id[l] = 0;
      hit.ray.flags[l] = 0;
      hit.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;
      hit.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(all_valid, scene.handle(), &context, &hit);

    for (int l = 0; l < packet; ++l) {
      if (hit.hit.instID[0][l] == RTC_INVALID_GEOMETRY_ID) continue;
      const RayScene::Surface& surface = surfaces[hit.hit.instID[0][l]];
      const Eigen::Vector3f n =
          surface.normal_to_world * Eigen::Vector3f(hit.hit.Ng_x[l], hit.hit.Ng_y[l], hit.hit.Ng_z[l]);
      hit.hit.Ng_x[l] = n.x();
      hit.hit.Ng_y[l] = n.y();
      hit.hit.Ng_z[l] = n.z();
      hit.hit.geomID[l] = hit.hit.instID[0][l];
    }
    for (int l = 0; l < packet; ++l) {
      const bool met = hit.hit.geomID[l] != RTC_INVALID_GEOMETRY_ID;
      const float nx = hit.hit.Ng_x[l];
      const float ny = hit.hit.Ng_y[l];
      const float nz = hit.hit.Ng_z[l];
      const int i = first + l;
      const int surface = met ? static_cast<int>(hit.hit.geomID[l]) : 0;
      rays.surface[i] = surface;
      rays.material[i] = surfaces[surface].material;
      rays.range_m[i + 1] = met ? hit.ray.tfar[l] : infinity;
      rays.normal_forward[i] = met ? nx * ahead.x() + ny * ahead.y() + nz * ahead.z() : 1.0f;
      rays.normal_up[i] = met ? nx * up.x() + ny * up.y() + nz * up.z() : 0.0f;
      rays.normal_left[i] = met ? nx * aside.x() + ny * aside.y() + nz * aside.z() : 0.0f;
      rays.inverse_norm[i] = met ? 1.0f / std::sqrt(nx * nx + ny * ny + nz * nz) : 1.0f;
    }
  }
}

void shade_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, RayColumn& rays) {
  for (int i = 0; i < rays.rays; ++i) {
    rays.slant[i] = rays.normal_forward[i] * rows.cosine[i] + rays.normal_up[i] * rows.sine[i];
  }
  const float* range_m = rays.range_m.data() + 1;
  scatter(rays.rays, rays.slant.data(), rays.inverse_norm.data(), range_m, rays.material.data(), rows.gain.data(),
          column.gain * column.width_rad, scene.scatter_table().data(), rays.cos_incidence.data(), rays.energy.data());
  spread_footprints(rays.rays, range_m, rays.slant.data(), rays.normal_forward.data(), rays.normal_up.data(),
                    rays.normal_left.data(), rows.cosine.data(), rows.edge_cosine.data(), rows.edge_sine.data(),
                    rows.gain_slope.data(), column.width_rad, rays.near_m.data(), rays.far_m.data(), rays.slope.data());
}

}  // namespace ensonify
