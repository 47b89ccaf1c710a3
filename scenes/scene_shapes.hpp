#pragma once

#include <string>
#include <vector>

#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/boulders.hpp"
#include "ensonify/scenes/scene_fields.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {

/// Names that `shape:` of an object may have.
const std::vector<std::string>& shape_names();

/// Reads the parameters of a shape and builds it. `ground` serves the shapes that rest on the seabed.
Assembly build_shape(const std::string& shape, const FieldSampler& field, RandomKey key, const ScatterGround& ground);

/// The height parameters of `fractal` and `rippled` (`flat` has none).
Terrain read_terrain(const std::string& shape, const FieldSampler& field, double spacing_m);

/// Refuses grids of more than 2 M nodes at the place of `spacing_m`.
void check_grid_size(const Reader& reader, const Eigen::Vector2d& size_m, double spacing_m);

}  // namespace ensonify
