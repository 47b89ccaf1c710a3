#pragma once

#include <vector>

#include "ensonify/config/reader.hpp"
#include "ensonify/scenes/material.hpp"

namespace ensonify {

/// Reads a mapping of names to {lambert_db, specular_db, specular_exponent, source}. Throws ConfigError.
std::vector<Material> read_materials(Reader& table);

/// The bundled table, scenes/library/materials/materials.yaml. Throws ConfigError where it is damaged.
std::vector<Material> bundled_materials();

}  // namespace ensonify
