#pragma once

#include <optional>
#include <vector>

#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/sim/probe.hpp"

/// Ghosts in a plane mirror by image sources (Allen and Berkley 1979), independent of the tracer: only the first hit of
/// single rays is shared, to see whether legs are free.
namespace ensonify::test {

struct Mirror {
  Vec3 point_m;
  Vec3 normal;  ///< unit
};

/// A cell of the image where a ghost lies.
struct Ghost {
  int bin;
  int beam;
  bool by_mirror;  ///< last leg from the mirror (bearing of the specular point), else from the surface point
  bool operator==(const Ghost&) const = default;
};

/// Nothing between two points but what ends the leg (within 2 mm).
inline bool leg_free(const RayScene& scene, const Vec3& from, const Vec3& to) {
  const double length = (to - from).norm();
  const Vec3 unit = (to - from) / length;
  const auto hit = first_hit_m(scene, from + 1e-3 * unit, unit, length - 3e-3);
  return !hit;
}

/// The two ghosts of surface point `p` that `mirror` makes: sonar - mirror - p - sonar and the same path backwards. The
/// sonar's image S' behind the mirror gives the specular point M where the line from p to S' cuts the plane, and the
/// length |p - S'| + |p - S|. None where M is not on the mirror's surface (the first thing met on the way to it), where
/// a leg is blocked, or where p or M is outside of the fan's nominal elevations; single ghosts outside of the window
/// are left out.
inline std::vector<Ghost> ghosts_of_point(const RayScene& scene, const Mirror& mirror, const Vec3& p,
                                          const SonarGeometry& sonar, const Pose& T_world_sonar) {
  const Vec3 s = T_world_sonar.translation();
  const double depth = (s - mirror.point_m).dot(mirror.normal);
  const double height = (p - mirror.point_m).dot(mirror.normal);
  if (!(depth * height > 0.0)) return {};
  const Vec3 image = s - 2.0 * depth * mirror.normal;
  const Vec3 m = p + (image - p) * (height / (height + depth));
  // On the surface itself, not only in its plane.
  const auto met = first_hit_m(scene, s, (m - s).normalized(), (m - s).norm() + 0.01);
  if (!met || std::abs(*met - (m - s).norm()) > 2e-3) return {};
  if (!leg_free(scene, s, p) || !leg_free(scene, m, p)) return {};
  const double half_length = 0.5 * ((p - image).norm() + (p - s).norm());
  const std::optional<int> bin = sonar.bin_of(half_length);
  if (!bin) return {};
  const Spherical at_p = to_spherical(T_world_sonar.inverse() * p);
  const Spherical at_m = to_spherical(T_world_sonar.inverse() * m);
  const double half_fov = 0.5 * sonar.elevation_fov_rad;
  const std::optional<int> beam_p = sonar.beam_of(at_p.azimuth_rad);
  const std::optional<int> beam_m = sonar.beam_of(at_m.azimuth_rad);
  if (!beam_p || !beam_m || std::abs(at_p.elevation_rad) > half_fov || std::abs(at_m.elevation_rad) > half_fov)
    return {};
  return {{*bin, *beam_p, false}, {*bin, *beam_m, true}};
}

/// Of many surface points; cells may repeat.
inline std::vector<Ghost> ghosts_of(const RayScene& scene, const Mirror& mirror, const std::vector<Vec3>& points,
                                    const SonarGeometry& sonar, const Pose& T_world_sonar) {
  std::vector<Ghost> ghosts;
  for (const Vec3& p : points) {
    for (const Ghost& ghost : ghosts_of_point(scene, mirror, p, sonar, T_world_sonar)) ghosts.push_back(ghost);
  }
  return ghosts;
}

}  // namespace ensonify::test
