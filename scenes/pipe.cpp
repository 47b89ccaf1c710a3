#include "ensonify/scenes/pipe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/tube.hpp"

namespace ensonify {
namespace {

constexpr double arc_step_rad = 0.13;  // 12 pieces a right angle

/// Place and direction at `along_m` of the path; z points along it.
Pose frame_at(const std::vector<Vec3>& path_m, double along_m) {
  std::size_t i = 0;
  double left_m = along_m;
  while (i + 2 < path_m.size() && left_m > (path_m[i + 1] - path_m[i]).norm()) {
    left_m -= (path_m[i + 1] - path_m[i]).norm();
    ++i;
  }
  const Vec3 direction = (path_m[i + 1] - path_m[i]).normalized();
  Pose frame = Pose::Identity();
  frame.translate(path_m[i] + left_m * direction);
  frame.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), direction));
  return frame;
}

TriangleMesh flange_mesh(const Pipe& pipe) {
  const double half = 0.5 * pipe.flange_thickness_m;
  if (pipe.wall_m <= 0) return make_cylinder(pipe.flange_radius_m, pipe.flange_thickness_m, pipe.segments);
  const double bore_m = pipe.radius_m - 0.5 * pipe.wall_m;  // in the middle of the wall: clear of both its faces
  return turn_ring_profile(
      {{bore_m, -half}, {pipe.flange_radius_m, -half}, {pipe.flange_radius_m, half}, {bore_m, half}}, pipe.segments);
}

void add_flanges(const Pipe& pipe, Assembly& assembly) {
  const double length_m = path_length_m(pipe.path_m), half_m = 0.5 * pipe.flange_thickness_m;
  const int gaps = std::max(1, static_cast<int>(std::lround(length_m / pipe.flange_spacing_m)));
  const double bolt_circle_m = 0.5 * (pipe.radius_m + pipe.flange_radius_m);
  const double bolt_radius_m = 0.25 * (pipe.flange_radius_m - pipe.radius_m);
  assembly.meshes.push_back(flange_mesh(pipe));
  if (pipe.bolts > 0) assembly.meshes.push_back(make_cylinder(bolt_radius_m, 2 * pipe.flange_thickness_m, 6));
  for (int i = 0; i <= gaps; ++i) {
    const double along_m = std::clamp(length_m * i / gaps, half_m, length_m - half_m);
    const Eigen::Affine3d T(frame_at(pipe.path_m, along_m).matrix());
    assembly.parts.push_back({1, T});
    for (int bolt = 0; bolt < pipe.bolts; ++bolt) {
      const double angle = 2 * std::numbers::pi * bolt / pipe.bolts;
      assembly.parts.push_back(
          {2, T * Eigen::Translation3d(bolt_circle_m * std::cos(angle), bolt_circle_m * std::sin(angle), 0)});
    }
  }
}

}  // namespace

std::vector<Vec3> round_corners(const std::vector<Vec3>& path_m, double bend_radius_m, std::size_t& too_tight) {
  std::vector<Vec3> rounded{path_m.front()};
  double used_m = 0;  // of the leg before, by the last bend
  too_tight = 0;
  for (std::size_t i = 1; i + 1 < path_m.size(); ++i) {
    const Vec3 in = (path_m[i] - path_m[i - 1]).normalized(), out = (path_m[i + 1] - path_m[i]).normalized();
    const double turn = std::atan2(in.cross(out).norm(), in.dot(out));
    const double tangent_m = bend_radius_m * std::tan(0.5 * turn);
    const double room_m = std::min((path_m[i] - path_m[i - 1]).norm() - used_m, (path_m[i + 1] - path_m[i]).norm());
    if (turn > radians(179) || tangent_m > room_m) {
      too_tight = i;
      return path_m;
    }
    used_m = tangent_m;
    if (turn < 1e-6) {
      rounded.push_back(path_m[i]);
      continue;
    }
    const Vec3 inward = (out - in).normalized();
    const Vec3 centre = path_m[i] + bend_radius_m / std::cos(0.5 * turn) * inward;
    const Vec3 first = path_m[i] - tangent_m * in;
    const Vec3 axis = in.cross(out).normalized();
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / arc_step_rad)));
    for (int k = 0; k <= pieces; ++k) {
      const Vec3 point = centre + Eigen::AngleAxisd(turn * k / pieces, axis) * (first - centre);
      if ((point - rounded.back()).norm() > 1e-6 * bend_radius_m) rounded.push_back(point);
    }
  }
  if ((path_m.back() - rounded.back()).norm() < 1e-6 * bend_radius_m) rounded.pop_back();
  rounded.push_back(path_m.back());
  return rounded;
}

Assembly build_pipe(const Pipe& pipe) {
  Assembly assembly = assembly_of(
      pipe.wall_m > 0 ? make_hollow_bar(pipe.path_m, pipe.radius_m, pipe.radius_m - pipe.wall_m, pipe.segments)
                      : make_bar(pipe.path_m, pipe.radius_m, pipe.segments));
  if (pipe.flange_spacing_m > 0) add_flanges(pipe, assembly);
  return assembly;
}

}  // namespace ensonify
