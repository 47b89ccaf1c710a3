#include "ensonify/sim/path_points.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {
namespace {

/// Where a surface is met at less than about 6 degrees its extent is that at 6 degrees.
constexpr float least_slant = 0.1f;
/// Of a tile's width and a row's height: neighbours' points, at other places, fill in the rest.
constexpr float own_share = 0.5f;

}  // namespace

void clear_point(PathPoints& p, int l) {
  p.x[l] = p.y[l] = p.z[l] = 0.0f;
  p.dx[l] = p.dy[l] = p.dz[l] = p.nx[l] = p.ny[l] = p.nz[l] = 0.0f;
  p.range_m[l] = p.cos_sonar[l] = p.density[l] = p.area_m2[l] = 1.0f;
  p.send[l] = p.mu[l] = p.specular[l] = p.lobe_share[l] = 0.0f;
  p.exponent[l] = 2.0f;
  p.ux[l] = p.uy[l] = p.uz[l] = p.vx[l] = p.vy[l] = p.vz[l] = 0.0f;
  p.column[l] = p.cell[l] = 0;
}

bool set_point(PathPoints& p, int l, const PathView& view, const Eigen::Vector3f& d, float r,
               const Eigen::Vector3f& normal, int surface) {
  clear_point(p, l);
  const RayAxes& axes = view.axes;
  const Eigen::Vector3f in_sonar(d.dot(axes.forward), d.dot(axes.left), d.dot(axes.up));
  const PathFan::Place place = view.fan.place_of(in_sonar);
  if (place.column < 0) return false;
  const int cell = view.tiles.grid().cell_of(place.u, place.v);
  const float width_rad = view.tiles.width(cell) * place.azimuth_rad;
  const float height_rad = view.tiles.height(cell) * place.elevation_rad;
  const float slant = normal.dot(d);
  const Eigen::Vector3f n = slant < 0.0f ? normal : Eigen::Vector3f(-normal);
  const float cos_sonar = std::max(std::abs(slant), 1e-4f);
  const SurfaceLaw& law =
      view.scene.laws()[static_cast<std::size_t>(view.scene.surfaces()[static_cast<std::size_t>(surface)].material)];

  // On the tangent plane n . (r d) stays, so a change of direction e moves the place by r (e + d (n . e) / cos).
  const float horizontal = std::max(std::hypot(in_sonar.x(), in_sonar.y()), 1e-6f);
  const Eigen::Vector3f across = (in_sonar.x() * axes.left - in_sonar.y() * axes.forward) / horizontal;
  const Eigen::Vector3f upwards =
      axes.up * horizontal - (in_sonar.x() * axes.forward + in_sonar.y() * axes.left) * (in_sonar.z() / horizontal);
  const float inverse_slant = 1.0f / std::max(cos_sonar, least_slant);
  const Eigen::Vector3f u = own_share * width_rad * horizontal * r * (across + d * (n.dot(across) * inverse_slant));
  const Eigen::Vector3f v = own_share * height_rad * r * (upwards + d * (n.dot(upwards) * inverse_slant));

  p.x[l] = r * d.x(), p.y[l] = r * d.y(), p.z[l] = r * d.z();
  p.dx[l] = d.x(), p.dy[l] = d.y(), p.dz[l] = d.z();
  p.nx[l] = n.x(), p.ny[l] = n.y(), p.nz[l] = n.z();
  p.range_m[l] = r;
  p.cos_sonar[l] = cos_sonar;
  p.send[l] = place.gain / cos_sonar;
  p.area_m2[l] = r * r / cos_sonar;
  p.density[l] = static_cast<float>(PathTiles::points) / (width_rad * height_rad * horizontal);
  p.mu[l] = law.mu, p.specular[l] = law.specular, p.exponent[l] = law.exponent, p.lobe_share[l] = law.lobe_share;
  p.ux[l] = u.x(), p.uy[l] = u.y(), p.uz[l] = u.z();
  p.vx[l] = v.x(), p.vy[l] = v.y(), p.vz[l] = v.z();
  p.column[l] = place.column;
  p.cell[l] = cell;
  return true;
}

Eigen::Vector3f lifted(const PathPoints& p, int l, const RayAxes& axes) {
  return axes.origin + Eigen::Vector3f(p.x[l] + lift_m * p.nx[l], p.y[l] + lift_m * p.ny[l], p.z[l] + lift_m * p.nz[l]);
}

PathHits::PathHits(const PathView& view)
    : blocks((static_cast<int>(view.tiles.tiles().size()) + packet_lanes - 1) / packet_lanes),
      packets(static_cast<std::size_t>(blocks * PathTiles::points)) {
  const RayAxes& axes = view.axes;
  const auto count = static_cast<int>(view.tiles.tiles().size());
  RayPacket rays;
  rays.origin.fill(axes.origin);
  rays.reach_m.fill(view.reach_m);
  for (int block = 0; block < blocks; ++block) {
    for (int q = 0; q < PathTiles::points; ++q) {
      for (int l = 0; l < packet_lanes; ++l) {
        rays.valid[l] = block * packet_lanes + l < count;
        if (!rays.valid[l]) continue;
        const PathTiles::Point point = view.tiles.point(view.tiles.tiles()[block * packet_lanes + l], q);
        const Eigen::Vector3f d = view.fan.direction(point.u, point.v);
        rays.direction[l] = d.x() * axes.forward + d.y() * axes.left + d.z() * axes.up;
      }
      const auto hits = rays.intersect(view.scene, true);
      PathPoints& out = packets[static_cast<std::size_t>(block * PathTiles::points + q)];
      for (int l = 0; l < packet_lanes; ++l) {
        if (hits[l].surface < 0)
          clear_point(out, l);
        else
          set_point(out, l, view, rays.direction[l], hits[l].distance_m, hits[l].normal, hits[l].surface);
      }
    }
  }
}

}  // namespace ensonify
