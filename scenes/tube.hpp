#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/loft.hpp"

namespace ensonify {

/// Frames along a polyline, z along it, turned as little as possible from one to the next (parallel transport); within
/// the polyline z halves the bend. Neighbouring points differ, and no bend is a full turn back.
std::vector<Pose> transport_frames(const std::vector<Vec3>& path_m);

/// Length (m) of a polyline.
double path_length_m(const std::vector<Vec3>& path_m);

/// Round bar along a polyline, ends capped.
TriangleMesh make_bar(const std::vector<Vec3>& path_m, double radius_m, int segments);
/// Open-ended pipe along a polyline; the inner radius is above 0 and below the outer.
TriangleMesh make_hollow_bar(const std::vector<Vec3>& path_m, double radius_m, double inner_radius_m, int segments);

/// Straight round members between two points.
struct Member {
  Vec3 from_m, to_m;
  double radius_m;
};

/// Instances of one cylinder.
Assembly assembly_of_members(const std::vector<Member>& members, int segments = 24);

}  // namespace ensonify
