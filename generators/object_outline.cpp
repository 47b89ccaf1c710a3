#include "ensonify/generators/object_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_measure.hpp"

namespace ensonify {
namespace {

using Eigen::Vector2d;
constexpr double pi = std::numbers::pi;
constexpr double half_section_m = 0.25;  // about the height of a small vehicle
constexpr double point_step_m = 0.1;

bool is_of(const std::string& instance, const std::string& object) {
  if (!instance.starts_with(object)) return false;
  const std::string_view rest = std::string_view(instance).substr(object.size());
  return rest.empty() || (rest[0] == '_' && rest.find_first_not_of("_0123456789") == std::string_view::npos);
}

std::vector<const Instance*> instances_of(const Scene& scene, const std::string& object) {
  std::vector<const Instance*> found;
  std::vector<std::string> names;
  for (const Instance& instance : scene.instances) {
    if (is_of(instance.name, object)) found.push_back(&instance);
    if (names.empty() || names.back() != instance.name) names.push_back(instance.name);
  }
  if (found.empty()) {
    const std::string nearest = nearest_word(object, names);
    throw ConfigError(fmt::format("scene {}: has no object '{}'{}", scene.name, object,
                                  nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  return found;
}

/// Keeps what of the polygon lies on the side of the plane z = height where sign * z <= sign * height.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, double height, double sign) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a.z() - height);
    const double db = sign * (b.z() - height);
    if (da <= 0.0) kept.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Andrew's monotone chain, counter-clockwise, corners only.
std::vector<Vector2d> convex_hull(std::vector<Vector2d> points) {
  if (points.empty()) return {};
  std::sort(points.begin(), points.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vector2d> hull;
  const auto add = [&](const Vector2d& p, std::size_t fixed) {
    while (hull.size() >= fixed + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 1e-12) {
      hull.pop_back();
    }
    if (hull.empty() || (hull.back() - p).norm() > 1e-6) hull.push_back(p);
  };
  for (const Vector2d& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  if (hull.size() > 1 && (hull.back() - hull.front()).norm() < 1e-6) hull.pop_back();
  return hull;
}

struct OutlinePoint {
  Vector2d at_m;
  Vector2d outward;
};

/// The hull widened by `distance_m`, counter-clockwise, in steps of about 0.1 m and at most 5 degrees.
std::vector<OutlinePoint> widened(const std::vector<Vector2d>& hull, double distance_m) {
  double around_m = 2.0 * pi * distance_m;
  for (std::size_t i = 0; i < hull.size(); ++i) around_m += (hull[(i + 1) % hull.size()] - hull[i]).norm();
  const double step_m = std::max(point_step_m, around_m / 1e5);
  const auto normal_of = [&](std::size_t edge) -> Vector2d {
    const Vector2d along = hull[(edge + 1) % hull.size()] - hull[edge % hull.size()];
    return Vector2d(along.y(), -along.x()).normalized();
  };
  std::vector<OutlinePoint> outline;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d& corner = hull[i];
    const Vector2d& next = hull[(i + 1) % hull.size()];
    const Vector2d before = normal_of(i + hull.size() - 1);
    const Vector2d normal = normal_of(i);
    // A hull of two points is a board seen from above: half a turn about each.
    const double turn = hull.size() == 2 ? pi : std::atan2(cross(before, normal), before.dot(normal));
    const double bearing = std::atan2(before.y(), before.x());
    const int bends = static_cast<int>(std::ceil(std::max(turn / radians(5.0), turn * distance_m / step_m)));
    for (int k = 0; k < bends; ++k) {
      const double angle = bearing + turn * k / bends;
      const Vector2d outward(std::cos(angle), std::sin(angle));
      outline.push_back({corner + distance_m * outward, outward});
    }
    const int steps = std::max(1, static_cast<int>(std::ceil((next - corner).norm() / step_m)));
    for (int k = 0; k < steps; ++k) {
      outline.push_back({corner + (next - corner) * (static_cast<double>(k) / steps) + distance_m * normal, normal});
    }
  }
  return outline;
}

bool faces(const Vector2d& outward, Side side) {
  if (side == Side::all) return true;
  const double bearing = (static_cast<int>(side) - static_cast<int>(Side::east)) * 0.5 * pi;
  return outward.dot(Vector2d(std::cos(bearing), std::sin(bearing))) >= std::cos(radians(45.0)) - 1e-9;
}

/// The longest run of points that are kept, round the end of the list too; all of them where all are.
std::vector<OutlinePoint> longest_run(const std::vector<OutlinePoint>& ring, const std::vector<bool>& kept) {
  const std::size_t n = ring.size();
  std::size_t best_first = 0, best = 0, run = 0;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    run = kept[i % n] ? run + 1 : 0;
    if (run > best && run <= n) {
      best = run;
      best_first = i + 1 - run;
    }
  }
  std::vector<OutlinePoint> result;
  for (std::size_t i = 0; i < best; ++i) result.push_back(ring[(best_first + i) % n]);
  return result;
}

}  // namespace

Eigen::AlignedBox3d object_box_m(const Scene& scene, const std::string& object) {
  Eigen::AlignedBox3d box;
  for (const Instance* instance : instances_of(scene, object)) {
    box.extend(bounding_box_m(scene.meshes[static_cast<std::size_t>(instance->mesh)], instance->T_world_object));
  }
  return box;
}

std::vector<Vector2d> object_outline_m(const Scene& scene, const std::string& object, double low_m, double high_m) {
  std::vector<Vector2d> points;
  for (const Instance* instance : instances_of(scene, object)) {
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(instance->mesh)];
    for (const auto& triangle : mesh.triangles) {
      std::vector<Vec3> corners;
      for (const std::uint32_t v : triangle) {
        corners.push_back(instance->T_world_object * mesh.vertices_m[v].cast<double>());
      }
      const auto [lowest, highest] = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
      if (lowest > high_m || highest < low_m) continue;
      for (const Vec3& p : cut(cut(corners, high_m, 1.0), low_m, -1.0)) points.push_back(p.head<2>());
    }
  }
  std::vector<Vector2d> hull = convex_hull(std::move(points));
  if (hull.size() < 2) {
    const Eigen::AlignedBox3d box = object_box_m(scene, object);
    throw ConfigError(
        fmt::format("scene {}: object '{}' has nothing between {:.2f} and {:.2f} m of depth; it spans "
                    "{:.2f} to {:.2f} m",
                    scene.name, object, -high_m, -low_m, -box.max().z(), -box.min().z()));
  }
  return hull;
}

SmoothedWay wall_way(const WallFollow& wall, const Scene& scene, double rounding_m) {
  const double z = -wall.depth_m;
  const auto ring =
      widened(object_outline_m(scene, wall.object, z - half_section_m, z + half_section_m), wall.standoff_m);
  std::vector<bool> kept;
  for (const OutlinePoint& p : ring) {
    kept.push_back(faces(p.outward, wall.side) && scene.navigable_m.contains(Vec3(p.at_m.x(), p.at_m.y(), z)));
  }
  std::vector<OutlinePoint> way = longest_run(ring, kept);
  if (way.size() < 2) {
    throw ConfigError(fmt::format(
        "scene {}: nothing of the way {} m from '{}' at {} m of depth lies in the navigable "
        "box{}; change standoff_m, depth_m or side",
        scene.name, wall.standoff_m, wall.object, wall.depth_m, wall.side == Side::all ? "" : " on that side"));
  }
  const bool whole = way.size() == ring.size();
  if (wall.clockwise) std::reverse(way.begin(), way.end());
  std::vector<PoseVector> knots;
  for (const OutlinePoint& p : way) {
    PoseVector knot;
    knot << p.at_m, z, 0.0, radians(wall.pitch_deg), std::atan2(-p.outward.y(), -p.outward.x());
    knots.push_back(knot);
  }
  const double half_m = std::min(rounding_m, 0.5 * wall.standoff_m);
  return whole ? round_and_round(knots, half_m) : there_and_back(unwrapped(std::move(knots)), half_m);
}

}  // namespace ensonify
