#include "ensonify/mapping/frustum_rows.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace ensonify {
namespace {

constexpr double everywhere = std::numeric_limits<double>::infinity();

struct Interval {
  double low = -everywhere;
  double high = everywhere;
};

/// Where c + b x + a x^2 <= 0: inside the roots for a > 0; outside of them (two intervals) for a < 0.
struct Below {
  Interval first;
  Interval second = {1, 0};
};

Below below_zero(double a, double b, double c) {
  constexpr Interval nowhere = {1, 0};
  if (a == 0) {
    if (b == 0) return {c <= 0 ? Interval{} : nowhere};
    return {b > 0 ? Interval{-everywhere, -c / b} : Interval{-c / b, everywhere}};
  }
  const double square = b * b - 4 * a * c;
  if (!(square > 0)) return {a > 0 ? nowhere : Interval{}};
  const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
  const double r1 = q / a;
  const double r2 = q != 0 ? c / q : r1;
  const auto [near, far] = std::minmax(r1, r2);
  if (a > 0) return {{near, far}};
  return {{-everywhere, near}, {far, everywhere}};
}

void cut(Interval& part, const Interval& by) {
  part.low = std::max(part.low, by.low);
  part.high = std::min(part.high, by.high);
}

/// Where value + slope x >= 0.
Interval above_zero(double value, double slope) { return below_zero(0, -slope, -value).first; }

}  // namespace

Frustum::Frustum(const SonarGeometry& geometry, double elevation_share, const Pose& T_world_sonar_)
    : range_max_m(geometry.range_max_m),
      tan_elevation(std::tan(0.5 * elevation_share * geometry.elevation_fov_rad)),
      T_world_sonar(T_world_sonar_) {
  const std::vector<double> edges = geometry.beam_edges_rad();
  port_rad = edges.front();
  starboard_rad = edges.back();
}

CellBox Frustum::reach(const GridFrame& frame) const {
  constexpr int steps = 36;
  const double half_elevation = std::atan(tan_elevation);
  const double azimuth_step = (port_rad - starboard_rad) / steps;
  const double elevation_step = 2 * half_elevation / steps;
  // Points of a polyhedron around the outer surface.
  const double outer_m = range_max_m / (std::cos(0.5 * azimuth_step) * std::cos(0.5 * elevation_step));
  Vec3 low = T_world_sonar.translation();
  Vec3 high = low;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const Vec3 p = T_world_sonar *
                     from_spherical({outer_m, starboard_rad + i * azimuth_step, j * elevation_step - half_elevation});
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  CellBox box;
  for (int a = 0; a < 3; ++a) {
    const double size = frame.size[a];
    box.low[a] = static_cast<int>(std::clamp(std::floor((low[a] - frame.origin_m[a]) / frame.resolution_m), 0.0, size));
    box.high[a] =
        static_cast<int>(std::clamp(std::ceil((high[a] - frame.origin_m[a]) / frame.resolution_m), 0.0, size));
  }
  return intersection(box, box_of(frame));
}

RowPieces pieces_in(const Frustum& frustum, const Vec3& p, const Vec3& d, int low, int high) {
  Interval all = {static_cast<double>(low), high - 1.0};
  cut(all,
      below_zero(d.squaredNorm(), 2 * p.dot(d), p.squaredNorm() - frustum.range_max_m * frustum.range_max_m).first);
  if (frustum.port_rad - frustum.starboard_rad < 0.99 * std::numbers::pi) {
    const auto side = [&](double azimuth, double sign) {
      const double s = sign * std::sin(azimuth);
      const double c = sign * std::cos(azimuth);
      cut(all, above_zero(s * p.x() - c * p.y(), s * d.x() - c * d.y()));
    };
    side(frustum.port_rad, 1);
    side(frustum.starboard_rad, -1);
  }
  const double t2 = frustum.tan_elevation * frustum.tan_elevation;
  const Below cone = below_zero(d.z() * d.z() - t2 * (d.x() * d.x() + d.y() * d.y()),
                                2 * (p.z() * d.z() - t2 * (p.x() * d.x() + p.y() * d.y())),
                                p.z() * p.z() - t2 * (p.x() * p.x() + p.y() * p.y()));
  RowPieces pieces;
  for (Interval part : {cone.first, cone.second}) {
    cut(part, all);
    if (!(part.low <= part.high)) continue;
    int from = std::max(low, static_cast<int>(std::ceil(part.low)) - 1);
    const int to = std::min(high, static_cast<int>(std::floor(part.high)) + 2);
    if (pieces.count > 0) from = std::max(from, pieces.piece[0][1]);
    if (from < to) pieces.piece[static_cast<std::size_t>(pieces.count++)] = {from, to};
  }
  return pieces;
}

}  // namespace ensonify
