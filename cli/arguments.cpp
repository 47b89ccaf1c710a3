#include "ensonify/cli/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <vector>

#include "ensonify/core/error.hpp"

namespace ensonify::cli {

CLI::Validator whole_number() { return CLI::Range(std::uint64_t{0}, std::uint64_t{9'000'000'000'000'000}); }

CLI::Validator above_zero() {
  return {[](std::string& text) {
            double number = 0;
            const bool good = CLI::detail::lexical_cast(text, number) && std::isfinite(number) && number > 0.0;
            return good ? std::string() : fmt::format("must be a finite number above 0, not {}", text);
          },
          "POSITIVE"};
}

CLI::Validator some_path() {
  return {[](std::string& text) { return text.empty() ? std::string("must not be empty") : std::string(); }, "PATH"};
}

namespace {

/// Six numbers, blanks or commas between, none beyond `largest`; empty where the text is anything else.
std::vector<double> six_numbers(const std::string& text, double largest) {
  std::string blanks = text;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::istringstream in(blanks);
  std::vector<double> v;
  for (double number = 0; in >> number;) v.push_back(number);
  const bool sane = std::all_of(v.begin(), v.end(), [&](double x) { return std::abs(x) <= largest; });
  return in.eof() && v.size() == 6 && sane ? v : std::vector<double>{};
}

}  // namespace

Pose parse_pose(const std::string& text, const char* option) {
  constexpr double far_off = 1e5;  // single precision ends to tell millimetres apart long before
  const std::vector<double> v = six_numbers(text, far_off);
  if (v.empty()) {
    throw ConfigError(
        fmt::format("{} \"{}\": must be six numbers, \"x y z roll pitch yaw\", metres and degrees "
                    "(z up, 0 at the water surface; positive pitch is nose down), none beyond 100000",
                    option, text));
  }
  return pose_from_xyz_rpy({v[0], v[1], v[2]}, radians(v[3]), radians(v[4]), radians(v[5]));
}

Twist parse_twist(const std::string& text) {
  constexpr double fastest = 180.0;
  const std::vector<double> v = six_numbers(text, fastest);
  if (v.empty()) {
    throw ConfigError(fmt::format(
        "--velocity \"{}\": must be six numbers, \"vx vy vz wx wy wz\" in the sonar's frame, m/s and deg/s, "
        "none beyond {}",
        text, fastest));
  }
  return {{v[0], v[1], v[2]}, {radians(v[3]), radians(v[4]), radians(v[5])}};
}

SonarModel open_sonar(const std::string& path_or_name, const RangeWindow& window) {
  if (window.range_max_m) {
    const SonarModel s = load_sonar(path_or_name);
    const double begin_m = window.range_min_m.value_or(s.geometry.range_min_m);
    if (*window.range_max_m <= begin_m || *window.range_max_m > s.instrument_range_max_m) {
      throw ConfigError(
          fmt::format("--range-max {0}: the range window {1} to {0} m must lie within the {2} to {3} m of {4}",
                      *window.range_max_m, begin_m, s.instrument_range_min_m, s.instrument_range_max_m, s.name));
    }
  }
  return load_sonar(path_or_name, window);
}

Scene open_scene(const std::string& path_or_name, std::uint64_t layout) {
  Scene scene = ensonify::open_scene(path_or_name, layout);
  for (const std::string& warning : scene.warnings) fmt::print(std::cerr, "ensonify: warning: {}\n", warning);
  const std::string extension = std::filesystem::path(path_or_name).extension().string();
  if (!scene.warnings.empty() && !extension.empty() && extension != ".yaml" && extension != ".yml") {
    fmt::print(std::cerr,
               "ensonify: a mesh by itself is taken as metres; unit and scale are keys of an object in a scene YAML "
               "that names it (docs/getting_started.md)\n");
  }
  return scene;
}

}  // namespace ensonify::cli
