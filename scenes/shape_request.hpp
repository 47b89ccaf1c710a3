#pragma once

#include <map>
#include <string>
#include <string_view>

#include "ensonify/scenes/assembly.hpp"
#include "ensonify/scenes/boulders.hpp"
#include "ensonify/scenes/scene_fields.hpp"

namespace ensonify {

constexpr Limits length_limits_m{1e-3, 1e4};
constexpr Limits unit_interval{0, 1};

/// What a shape is built from: its parameters, its random numbers and the ground it may rest on.
struct ShapeRequest {
  const FieldSampler& field;
  RandomKey key;
  const ScatterGround& ground;

  double length(std::string_view name) const { return field.number(name, length_limits_m); }
  double length_or(std::string_view name, double fallback) const {
    return field.number_or(name, fallback, length_limits_m);
  }
  /// One of `choices`, the first where the file says nothing.
  std::string choice_or_first(std::string_view name, const std::vector<std::string>& choices) const {
    return field.reader.has(name) ? field.reader.choice(name, choices) : choices.front();
  }
  /// Refuses at `name` what would take more than a million triangles.
  void check_triangles(std::string_view name, double triangles) const;
};

/// Reads the parameters of one shape and builds it; throws ConfigError at the parameter at fault.
using ShapeBuilder = Assembly (*)(const ShapeRequest&);
using ShapeTable = std::map<std::string, ShapeBuilder>;

// The families; a new shape is a builder and a line in the table of its family.
ShapeTable solid_shapes();
ShapeTable line_shapes();
ShapeTable ground_shapes();
ShapeTable structure_shapes();
ShapeTable vessel_shapes();

}  // namespace ensonify
