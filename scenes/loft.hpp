#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/mesh.hpp"
#include "ensonify/scenes/polygon.hpp"

namespace ensonify {

/// A closed loop of points (m); the loops of one loft have the same number of points.
using Ring = std::vector<Vec3>;

// Skins over rings. Points that coincide are joined, so a ring may shrink to a point or a line. The result is closed
// and turned outward whichever way the rings run, as long as the skin does not cross itself.

/// Open stack of rings; the first and last are capped by the triangles of `cap` (indices into a ring).
TriangleMesh loft(const std::vector<Ring>& rings, const std::vector<std::array<std::uint32_t, 3>>& cap);
/// The last ring is joined to the first.
TriangleMesh loft_loop(const std::vector<Ring>& rings);

/// Fan from point 0: the cap of a convex ring.
std::vector<std::array<std::uint32_t, 3>> fan_cap(std::size_t points);

/// Prism of a simple polygon in x, y, from z_low_m to z_high_m.
TriangleMesh extrude(const Polygon& profile, double z_low_m, double z_high_m);

/// A polyline of (radius, z) turned about z; ends off the axis are closed by discs. All radii but those of the ends are
/// above 0.
TriangleMesh turn_profile(const Polygon& profile, int segments);
/// A closed profile that keeps clear of the axis.
TriangleMesh turn_ring_profile(const Polygon& profile, int segments);

/// All meshes as one.
TriangleMesh joined(const std::vector<TriangleMesh>& meshes);

}  // namespace ensonify
