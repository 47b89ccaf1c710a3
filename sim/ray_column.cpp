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
      energy(static_cast<std::size_t>(count)),
      cos_incidence(static_cast<std::size_t>(count)),
      near_m(static_cast<std::size_t>(count)),
      far_m(static_cast<std::size_t>(count)) {}

void cast_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, const RayAxes& axes,
                 float reach_m, RayColumn& rays) {
  const Eigen::Vector3f ahead = column.cosine * axes.forward + column.sine * axes.left;
  const Eigen::Vector3f aside = column.cosine * axes.left - column.sine * axes.forward;
  const Eigen::Vector3f& up = axes.up;
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
      const RayScene::Surface& surface = scene.surfaces()[hit.hit.instID[0][l]];
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
      rays.range_m[i + 1] = met ? hit.ray.tfar[l] : infinity;
      rays.surface[i] = met ? static_cast<int>(hit.hit.geomID[l]) : 0;
      rays.normal_forward[i] = met ? nx * ahead.x() + ny * ahead.y() + nz * ahead.z() : 1.0f;
      rays.normal_up[i] = met ? nx * up.x() + ny * up.y() + nz * up.z() : 0.0f;
      rays.normal_left[i] = met ? nx * aside.x() + ny * aside.y() + nz * aside.z() : 0.0f;
      rays.inverse_norm[i] = met ? 1.0f / std::sqrt(nx * nx + ny * ny + nz * nz) : 1.0f;
    }
  }
}

void shade_column(const RayScene& scene, const RayFan::Rows& rows, const RayFan::Column& column, RayColumn& rays) {
  const float* table = scene.scatter_table().data();
  const RayScene::Surface* surfaces = scene.surfaces().data();
  const float column_gain = column.gain * column.width_rad;
  for (int i = 0; i < rays.rays; ++i) {
    const float slant = rays.normal_forward[i] * rows.cosine[i] + rays.normal_up[i] * rows.sine[i];
    const float cosine = std::min(std::abs(slant) * rays.inverse_norm[i], 1.0f);
    const float place = std::sqrt(1.0f - cosine) * static_cast<float>(RayScene::scatter_steps);
    const int step = static_cast<int>(place);
    const float* entry = table + (surfaces[rays.surface[i]].material * RayScene::scatter_stride + step);
    const float scatter = entry[0] + (place - static_cast<float>(step)) * (entry[1] - entry[0]);
    rays.cos_incidence[i] = cosine;
    rays.energy[i] = rays.range_m[i + 1] < infinity ? scatter * rows.gain[i] * column_gain : 0.0f;
  }
  for (int i = 0; i < rays.rays; ++i) {
    // On the tangent plane n . (r d) is constant, so r at a border is r n.d / n.d_border.
    const float r = rays.range_m[i + 1];
    const float slant = rays.normal_forward[i] * rows.cosine[i] + rays.normal_up[i] * rows.sine[i];
    const float lower = rays.normal_forward[i] * rows.edge_cosine[i] + rays.normal_up[i] * rows.edge_sine[i];
    const float upper = rays.normal_forward[i] * rows.edge_cosine[i + 1] + rays.normal_up[i] * rows.edge_sine[i + 1];
    const float below = rays.range_m[i];
    const float above = rays.range_m[i + 2];
    float r_lower = slant * lower > 0.0f ? r * (slant / lower) : infinity;
    float r_upper = slant * upper > 0.0f ? r * (slant / upper) : infinity;
    r_lower = std::min(std::max(r_lower, std::min(r, below)), std::max(r, below));
    r_upper = std::min(std::max(r_upper, std::min(r, above)), std::max(r, above));
    r_lower = r_lower < infinity ? r_lower : r;
    r_upper = r_upper < infinity ? r_upper : r;
    const float arc = r * rows.cosine[i] * column.width_rad;
    const float slope = std::abs(rays.normal_left[i]) / std::max(std::abs(slant), 1e-20f);
    const float across = arc * std::min(slope * rows.cosine[i], steepest_azimuth_slope);
    const float along = std::abs(r_upper - r_lower);
    const float half = 0.5f * std::sqrt(along * along + across * across);
    const float middle = 0.5f * (r_lower + r_upper);
    rays.near_m[i] = middle - half;
    rays.far_m[i] = middle + half;
  }
}

}  // namespace ensonify
