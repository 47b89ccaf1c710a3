#include "ensonify/generators/explore_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/sim/voxelize.hpp"

namespace ensonify {
namespace {

/// The share of the elevations that the model takes for seen.
double elevation_share(const InverseModel& model) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.shape; }) return m.shape.elevation_share;
        return 1.0;
      },
      model);
}

Pose start_of(const Scene& scene, const SiteRequest& request) {
  Pose start = Pose::Identity();
  if (request.start) {
    start = *request.start;
  } else if (!scene.waypoints.empty()) {
    const Pose& first = scene.waypoints.front();
    start = pose_from_xyz_rpy(first.translation(), 0, 0, roll_pitch_yaw(first)[2]);
  } else {
    start.translation() = scene.navigable_m.center();
  }
  if (request.z_m) start.translation().z() = *request.z_m;
  return start;
}

/// Columns whose centre lies in the box, grown by `more_m`.
ColumnMask columns_in(const Slice& slice, const Eigen::AlignedBox3d& box, double more_m) {
  ColumnMask inside(slice.columns.size());
  for (int iy = 0; iy < slice.frame.size[1]; ++iy) {
    for (int ix = 0; ix < slice.frame.size[0]; ++ix) {
      const double x = slice.x_m(ix);
      const double y = slice.y_m(iy);
      inside[slice.index(ix, iy)] = x >= box.min().x() - more_m && x <= box.max().x() + more_m &&
                                            y >= box.min().y() - more_m && y <= box.max().y() + more_m
                                        ? 1
                                        : 0;
    }
  }
  return inside;
}

void check_start(const ExploreSite& site, const Vehicle& vehicle, const Eigen::AlignedBox3d& navigable_m) {
  const Vec3 at = site.start.translation();
  const auto place = fmt::format("start at {:.2f} {:.2f} {:.2f}", at.x(), at.y(), at.z());
  const PlanarPose start = site.planar_start();
  const double room_m = clearance_m(site.truth, start, start, std::max(vehicle.radius_m, site.known_free_m) + 0.01);
  if (std::ranges::count(site.reachable.free, 1) == 0) {
    if (!navigable_m.contains(Vec3(at.x(), at.y(), navigable_m.center().z()))) {
      throw ConfigError(fmt::format(
          "{}: lies outside of the scene's navigable box, x {:.2f} to {:.2f} and y {:.2f} to {:.2f}; choose another "
          "start",
          place, navigable_m.min().x(), navigable_m.max().x(), navigable_m.min().y(), navigable_m.max().y()));
    }
    throw ConfigError(
        fmt::format("{}: must be {} m off everything, but the nearest surface is at {:.2f} m; choose another start, "
                    "depth or radius",
                    place, vehicle.radius_m, room_m));
  }
  if (room_m < site.known_free_m) {
    throw ConfigError(fmt::format(
        "{}: {:.2f} m around are taken as known to be free, since the sonar can not see them, but a surface is at "
        "{:.2f} m; choose another start, or a smaller known-free radius or height",
        place, site.known_free_m, room_m));
  }
}

}  // namespace

PlanarPose planar(const Pose& pose) {
  return {pose.translation().x(), pose.translation().y(), roll_pitch_yaw(pose)[2]};
}

PlanarPose ExploreSite::planar_start() const { return planar(start); }

Pose ExploreSite::pose_at(const PlanarPose& p) const {
  const auto [roll, pitch, yaw] = roll_pitch_yaw(start);
  return pose_from_xyz_rpy({p.x_m, p.y_m, start.translation().z()}, roll, pitch, p.yaw_rad);
}

ExploreSite explore_site(const Scene& scene, const SonarModel& sonar, const InverseModel& model, const Vehicle& vehicle,
                         const SiteRequest& request) {
  ExploreSite site;
  site.start = start_of(scene, request);
  const double z_m = site.start.translation().z();
  const OccupancyGrid truth = voxelize(scene, request.resolution_m.value_or(scene.grid_resolution_m)).grid;
  const GridFrame slab = slab_of(truth.frame, z_m, vehicle.height_m);
  // `points` takes every echo for one of elevation 0: it never says anything of other layers.
  const bool flat = std::holds_alternative<Points>(model);
  site.map_frame = slab_of(truth.frame, z_m, flat ? 0.0 : vehicle.height_m);
  site.view = view_of(sonar.geometry, elevation_share(model) * sonar.geometry.elevation_fov_rad, site.map_frame, z_m);
  site.truth = slice_of(truth, slab);
  site.area = columns_in(site.truth, scene.navigable_m, 0.0);
  site.interest = columns_in(site.truth, scene.navigable_m, vehicle.radius_m);
  site.known_free_m = request.known_free_m.value_or(
      std::max(site.view.nearest_m, vehicle.radius_m + vehicle.margin_m + slab.resolution_m) + slab.resolution_m);
  site.reachable =
      reachable_slice(site.truth, site.area, site.planar_start(), vehicle.radius_m, sonar.geometry.range_max_m);
  check_start(site, vehicle, scene.navigable_m);
  return site;
}

}  // namespace ensonify
