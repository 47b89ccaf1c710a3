#include "ensonify/generators/random_pose.hpp"

#include "ensonify/sim/probe.hpp"

namespace ensonify {
namespace {

/// Share of a coarse fan's rays over the nominal field of view that meet something within the range window.
double seen_share(const RayScene& rays, const SonarGeometry& geometry, const Pose& T_world_sonar) {
  constexpr int columns = 16;
  constexpr int rows = 5;
  const double port = geometry.beam_azimuth_rad.front();
  const double starboard = geometry.beam_azimuth_rad.back();
  int seen = 0;
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) {
      const double theta = port + (starboard - port) * (c + 0.5) / columns;
      const double phi = geometry.elevation_fov_rad * ((r + 0.5) / rows - 0.5);
      const Vec3 direction = T_world_sonar.linear() * from_spherical({1.0, theta, phi});
      const auto hit = first_hit_m(rays, T_world_sonar.translation(), direction, geometry.range_max_m);
      seen += hit.has_value() && *hit >= geometry.range_min_m;
    }
  }
  return static_cast<double>(seen) / (columns * rows);
}

}  // namespace

std::optional<SampledPose> sample_pose(const RandomPoses& poses, const Place& place, const SonarGeometry& geometry,
                                       RandomKey key) {
  const Vec3 low = place.scene.navigable_m.min();
  const Vec3 high = place.scene.navigable_m.max();
  for (int attempt = 1; attempt <= poses.tries; ++attempt) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(attempt)));
    const Vec3 position(random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y()),
                        random.uniform(low.z(), high.z()));
    if (!has_room(place.truth, position, poses.clearance_m)) continue;
    const double roll = radians(sample(poses.roll_deg, random));
    const double pitch = radians(sample(poses.pitch_deg, random));
    const double yaw = radians(sample(poses.yaw_deg, random));
    const Pose T_world_sonar = pose_from_xyz_rpy(position, roll, pitch, yaw);
    if (seen_share(place.rays, geometry, T_world_sonar) < poses.least_seen_share) continue;
    return SampledPose{T_world_sonar, attempt};
  }
  return std::nullopt;
}

}  // namespace ensonify
