#include "ensonify/cli/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <vector>

#include "ensonify/core/error.hpp"

namespace ensonify::cli {

Pose parse_pose(const std::string& text) {
  std::string blanks = text;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::istringstream in(blanks);
  std::vector<double> v;
  for (double number = 0; in >> number;) v.push_back(number);
  const bool finite = std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  if (!in.eof() || v.size() != 6 || !finite) {
    throw ConfigError(
        fmt::format("--pose \"{}\": must be six numbers, \"x y z roll pitch yaw\", metres and degrees "
                    "(z up, 0 at the water surface; positive pitch is nose down)",
                    text));
  }
  return pose_from_xyz_rpy({v[0], v[1], v[2]}, radians(v[3]), radians(v[4]), radians(v[5]));
}

Scene open_scene(const std::string& path_or_name, std::uint64_t layout) {
  const std::filesystem::path path = path_or_name;
  std::error_code no_throw;
  const bool yaml = path.extension() == ".yaml" || path.extension() == ".yml" || !path.has_extension();
  if (!yaml && !std::filesystem::is_regular_file(path, no_throw)) {
    throw DataError(fmt::format("{}: no such file", path_or_name));
  }
  Scene scene = yaml ? load_scene(path_or_name, layout) : scene_from_mesh(path);
  for (const std::string& warning : scene.warnings) fmt::print(std::cerr, "ensonify: warning: {}\n", warning);
  return scene;
}

}  // namespace ensonify::cli
