#pragma once

#include "ensonify/scenes/mesh.hpp"

namespace ensonify {

/// Screw about the x axis, its middle at the origin: hub and twisted blades, each part closed, overlapping.
TriangleMesh make_propeller(double radius_m, int blades = 4);

}  // namespace ensonify
