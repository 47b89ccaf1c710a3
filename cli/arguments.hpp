#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"
#include "ensonify/sim/ping_motion.hpp"

namespace ensonify::cli {

/// A seed or layout number: whole, not negative, exact in JSON.
CLI::Validator whole_number();
/// A finite number above 0.
CLI::Validator above_zero();
/// A path that is not empty.
CLI::Validator some_path();

/// "x y z roll pitch yaw", metres and degrees, blanks or commas between. Throws ConfigError naming `option`.
Pose parse_pose(const std::string& text, const char* option = "--pose");

/// "vx vy vz wx wy wz" in the sonar's frame, m/s and deg/s. Throws ConfigError.
Twist parse_twist(const std::string& text);

/// A sonar YAML or a bundled name, set to a window whose end is that of --range-max. Throws ConfigError naming the
/// option where the instrument can not be set to it.
SonarModel open_sonar(const std::string& path_or_name, const RangeWindow& window);

/// A scene YAML, a bundled name, or a mesh file by itself (any other extension). Its warnings go to standard error.
Scene open_scene(const std::string& path_or_name, std::uint64_t layout);

}  // namespace ensonify::cli
