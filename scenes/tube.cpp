#include "ensonify/scenes/tube.hpp"

#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"

namespace ensonify {
namespace {

/// Circles about the path, widened at bends so that the bar keeps its radius beside them.
std::vector<Ring> circles(const std::vector<Vec3>& path_m, double radius_m, int segments) {
  const std::vector<Pose> frames = transport_frames(path_m);
  std::vector<Ring> rings(path_m.size());
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    const Vec3 along = frames[i].linear().col(2);
    const bool bends = i > 0 && i + 1 < path_m.size();
    const Vec3 leg = bends ? Vec3((path_m[i + 1] - path_m[i]).normalized()) : along;
    const double cos_half_bend = along.dot(leg);
    const Vec3 outward = leg - cos_half_bend * along;  // in the plane of the ring, across the axis of the bend
    const double widening = 1 / cos_half_bend - 1;
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * std::numbers::pi * s / segments;
      Vec3 spoke = frames[i].linear() * Vec3(std::cos(angle), std::sin(angle), 0);
      if (outward.squaredNorm() > 1e-18) {
        spoke += widening * spoke.dot(outward.normalized()) * outward.normalized();
      }
      rings[i].push_back(path_m[i] + radius_m * spoke);
    }
  }
  return rings;
}

}  // namespace

std::vector<Pose> transport_frames(const std::vector<Vec3>& path_m) {
  std::vector<Pose> frames;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Vec3 before = Vec3::UnitZ();
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    Vec3 along = Vec3::Zero();
    if (i > 0) along += (path_m[i] - path_m[i - 1]).normalized();
    if (i + 1 < path_m.size()) along += (path_m[i + 1] - path_m[i]).normalized();
    along.normalize();
    turn = (Eigen::Quaterniond::FromTwoVectors(before, along) * turn).normalized();
    before = along;
    Pose frame = Pose::Identity();
    frame.translate(path_m[i]).rotate(turn);
    frames.push_back(frame);
  }
  return frames;
}

double path_length_m(const std::vector<Vec3>& path_m) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) length += (path_m[i + 1] - path_m[i]).norm();
  return length;
}

TriangleMesh make_bar(const std::vector<Vec3>& path_m, double radius_m, int segments) {
  return loft(circles(path_m, radius_m, segments), fan_cap(static_cast<std::size_t>(segments)));
}

TriangleMesh make_hollow_bar(const std::vector<Vec3>& path_m, double radius_m, double inner_radius_m, int segments) {
  std::vector<Ring> rings = circles(path_m, radius_m, segments);
  const std::vector<Ring> inner = circles(path_m, inner_radius_m, segments);
  rings.insert(rings.end(), inner.rbegin(), inner.rend());
  return loft_loop(rings);
}

Assembly assembly_of_members(const std::vector<Member>& members, int segments) {
  Assembly result = {{make_cylinder(1.0, 1.0, segments)}, {}};
  for (const Member& member : members) {
    const Vec3 span = member.to_m - member.from_m;
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(0.5 * (member.from_m + member.to_m)).rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), span));
    T.scale(Vec3(member.radius_m, member.radius_m, span.norm()));
    result.parts.push_back({0, T});
  }
  return result;
}

}  // namespace ensonify
