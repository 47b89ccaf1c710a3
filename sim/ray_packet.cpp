#include "ensonify/sim/ray_packet.hpp"

#include <embree3/rtcore.h>

namespace ensonify {
namespace {

/// Where the instruction set has no packets of eight, Embree passes over the mask, and goes by tnear <= tfar alone: a
/// lane that is not valid is an empty ray as well, whatever its place in the packet holds.
void fill(const RayPacket& packet, const std::array<float, packet_lanes>& reach, RTCRay8& ray, int* valid) {
  for (int l = 0; l < packet_lanes; ++l) {
    const Eigen::Vector3f origin = packet.valid[l] ? packet.origin[l] : Eigen::Vector3f::Zero();
    const Eigen::Vector3f direction = packet.valid[l] ? packet.direction[l] : Eigen::Vector3f::UnitX();
    ray.org_x[l] = origin.x();
    ray.org_y[l] = origin.y();
    ray.org_z[l] = origin.z();
    ray.dir_x[l] = direction.x();
    ray.dir_y[l] = direction.y();
    ray.dir_z[l] = direction.z();
    ray.tnear[l] = 0.0f;
    ray.tfar[l] = packet.valid[l] ? reach[l] : -1.0f;
    ray.time[l] = 0.0f;
    ray.mask[l] = ~0u;
    ray.id[l] = 0;
    ray.flags[l] = 0;
    valid[l] = packet.valid[l] ? -1 : 0;
  }
}

}  // namespace

std::array<RayPacket::Hit, packet_lanes> RayPacket::intersect(const RayScene& scene, bool coherent) const {
  alignas(32) RTCRayHit8 ray;
  alignas(32) int lanes[packet_lanes];
  fill(*this, reach_m, ray.ray, lanes);
  for (int l = 0; l < packet_lanes; ++l) {
    ray.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(lanes, scene.handle(), &context, &ray);

  std::array<Hit, packet_lanes> hits;
  for (int l = 0; l < packet_lanes; ++l) {
    if (!valid[l] || ray.hit.geomID[l] == RTC_INVALID_GEOMETRY_ID) continue;
    const bool instanced = ray.hit.instID[0][l] != RTC_INVALID_GEOMETRY_ID;
    const unsigned id = instanced ? ray.hit.instID[0][l] : ray.hit.geomID[l];
    Eigen::Vector3f n(ray.hit.Ng_x[l], ray.hit.Ng_y[l], ray.hit.Ng_z[l]);
    if (instanced) n = scene.surfaces()[id].normal_to_world * n;
    hits[l] = {ray.ray.tfar[l], static_cast<int>(id), n.normalized()};
  }
  return hits;
}

std::array<bool, packet_lanes> RayPacket::occluded(const RayScene& scene) const {
  alignas(32) RTCRay8 ray;
  alignas(32) int lanes[packet_lanes];
  static constexpr std::array<float, packet_lanes> to_the_end{1, 1, 1, 1, 1, 1, 1, 1};
  fill(*this, to_the_end, ray, lanes);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(lanes, scene.handle(), &context, &ray);
  std::array<bool, packet_lanes> blocked{};
  for (int l = 0; l < packet_lanes; ++l) blocked[l] = valid[l] && ray.tfar[l] < 0.0f;
  return blocked;
}

}  // namespace ensonify
