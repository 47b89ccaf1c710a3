#pragma once

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

// Closed shapes about their centre, axis along z, turned outward. Lengths in metres, all above 0.

TriangleMesh make_box(const Vec3& size_m);
/// Icosphere: 20 * 4^detail triangles, vertices on the sphere.
TriangleMesh make_sphere(double radius_m, int detail = 3);
/// The rim is a regular polygon inscribed in the circle.
TriangleMesh make_cylinder(double radius_m, double height_m, int segments = 48);
/// Frustum; a top radius of 0 ends in a point.
TriangleMesh make_cone(double radius_m, double top_radius_m, double height_m, int segments = 48);

/// Ring about z: `tube_segments` across the tube, `segments` around. The tube radius is below the ring radius.
TriangleMesh make_torus(double ring_radius_m, double tube_radius_m, int segments = 64, int tube_segments = 24);

/// Open rectangle in z = 0, seen from +z.
TriangleMesh make_plane(double length_m, double width_m);

/// Boat hull: x forward, z = 0 at its waterline, a flat deck `freeboard_m` above and the keel `draft_m` below.
TriangleMesh make_hull(double length_m, double beam_m, double draft_m, double freeboard_m);

}  // namespace ensonify
