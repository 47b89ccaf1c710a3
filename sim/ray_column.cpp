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
      energy(static_cast<std::size_t>(count)),
      cos_incidence(static_cast<std::size_t>(count)),
      near_m(static_cast<std::size_t>(count)),
      far_m(static_cast<std::size_t>(count)) {}

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
  // The arrays do not overlap: said, so that the loops become vector code.
  const float* __restrict range = rays.range_m.data() + 1;
  const float* __restrict ahead = rays.normal_forward.data();
  const float* __restrict up = rays.normal_up.data();
  const float* __restrict left = rays.normal_left.data();
  const float* __restrict inverse_norm = rays.inverse_norm.data();
  const int* __restrict material = rays.material.data();
  float* __restrict energy = rays.energy.data();
  float* __restrict cos_incidence = rays.cos_incidence.data();
  float* __restrict near_m = rays.near_m.data();
  float* __restrict far_m = rays.far_m.data();
  const float* __restrict cosine = rows.cosine.data();
  const float* __restrict sine = rows.sine.data();
  const float* __restrict edge_cosine = rows.edge_cosine.data();
  const float* __restrict edge_sine = rows.edge_sine.data();
  const float* __restrict gain = rows.gain.data();
  const float* __restrict table = scene.scatter_table().data();
  const float column_gain = column.gain * column.width_rad;
  const int count = rays.rays;

  for (int i = 0; i < count; ++i) {
    const float slant = ahead[i] * cosine[i] + up[i] * sine[i];
    const float incidence = std::min(std::abs(slant) * inverse_norm[i], 1.0f);
    const float place = std::sqrt(1.0f - incidence) * static_cast<float>(RayScene::scatter_steps);
    const int step = static_cast<int>(place);
    const int entry = material[i] * RayScene::scatter_stride + step;
    const float scatter = table[entry] + (place - static_cast<float>(step)) * (table[entry + 1] - table[entry]);
    cos_incidence[i] = incidence;
    energy[i] = range[i] < infinity ? scatter * gain[i] * column_gain : 0.0f;
  }
  for (int i = 0; i < count; ++i) {
    // On the tangent plane n . (r d) is constant, so r at a border is r n.d / n.d_border; a plane that the border
    // misses gives a negative or infinite r, taken as infinity.
    const float r = range[i];
    const float slant = ahead[i] * cosine[i] + up[i] * sine[i];
    const float below = range[i - 1];
    const float above = range[i + 1];
    const float at_lower = r * (slant / (ahead[i] * edge_cosine[i] + up[i] * edge_sine[i]));
    const float at_upper = r * (slant / (ahead[i] * edge_cosine[i + 1] + up[i] * edge_sine[i + 1]));
    float lower = at_lower > 0.0f ? at_lower : infinity;
    float upper = at_upper > 0.0f ? at_upper : infinity;
    lower = std::min(std::max(lower, std::min(r, below)), std::max(r, below));
    upper = std::min(std::max(upper, std::min(r, above)), std::max(r, above));
    lower = lower < infinity ? lower : r;
    upper = upper < infinity ? upper : r;
    const float slope = std::abs(left[i]) / std::max(std::abs(slant), 1e-20f);
    const float across = r * cosine[i] * column.width_rad * std::min(slope * cosine[i], steepest_azimuth_slope);
    const float along = upper - lower;
    const float half = 0.5f * std::sqrt(along * along + across * across);
    const float middle = 0.5f * (lower + upper);
    near_m[i] = middle - half;
    far_m[i] = middle + half;
  }
}

}  // namespace ensonify
