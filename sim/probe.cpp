#include "ensonify/sim/probe.hpp"

#include <embree3/rtcore.h>

#include "ensonify/sim/flush_denormals.hpp"

namespace ensonify {

std::optional<double> first_hit_m(const RayScene& scene, const Vec3& origin_m, const Vec3& direction, double reach_m) {
  const FlushDenormals flush;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin_m.x());
  ray.ray.org_y = static_cast<float>(origin_m.y());
  ray.ray.org_z = static_cast<float>(origin_m.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = static_cast<float>(reach_m);
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.handle(), &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return static_cast<double>(ray.ray.tfar);
}

}  // namespace ensonify
