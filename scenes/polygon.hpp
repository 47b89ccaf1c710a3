#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ensonify {

/// Corners of a closed polygon in order, the last joined to the first.
using Polygon = std::vector<Eigen::Vector2d>;

/// Positive where the corners run counter-clockwise.
double signed_area(const Polygon& polygon);

/// At least three corners, all edges longer than 0, and none meets another but at the corner they share.
bool is_simple(const Polygon& polygon);

/// Ear clipping of a simple, counter-clockwise polygon: corners - 2 counter-clockwise triangles, O(n^2).
std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon);

}  // namespace ensonify
