#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/recipe.hpp"

/// Recipes over two small places that differ in name alone, one with a way through it and one with a way into the
/// block.
namespace ensonify::test {

inline const std::string small_place = R"(
bounds: {min: [-4, -4, -4], max: [4, 4, 0]}
navigable: {min: [-3, -3, -3], max: [3, 3, -1]}
grid_resolution_m: 0.1
objects:
  - {name: block, shape: box, length_m: 1, width_m: 1, height_m: 1, pose: [0, 0, -2], material: concrete}
  - {name: wall, shape: box, length_m: 0.3, width_m: 7, height_m: 3.5, pose: [3.7, 0, -2], material: concrete}
)";

inline const std::string random_split = R"(  train:
    frames: 6
    places: [{scene: a.yaml}, {scene: b.yaml}]
    random_poses: {pitch_deg: {uniform: [-5, 25]}, clearance_m: 0.3, least_seen_share: 0.02, tries: 2000}
)";
inline const std::string swum_split = R"(  test:
    frames: 5
    places: [{scene: way.yaml}]
    trajectory: {speed_mps: 0.5, rate_hz: 2}
)";
inline const std::string head = R"(name: test
sonar: {model: oculus_m1200d_hf, range_min_m: 0.1, range_max_m: {uniform: [4, 6]}, range_bins: 128, gain_db: {uniform: [-3, 3]}}
noise: paper
)";

class Frames : public testing::Test {
 protected:
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("ensonify_frames_" + std::to_string(::getpid()));
  void SetUp() override {
    std::filesystem::create_directories(folder);
    for (const char* name : {"a.yaml", "b.yaml"}) write(name, "title: place\n" + small_place);
    write("way.yaml",
          "title: way\n" + small_place + "waypoints:\n  - [-2, -2, -2, 0, 0, 0]\n  - [-2, 2, -2, 0, 0, 0]\n");
    write("into.yaml",
          "title: into\n" + small_place + "waypoints:\n  - [-2, 0, -2, 0, 0, 0]\n  - [2, 0, -2, 0, 0, 0]\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  Recipe recipe(const std::string& text) const {
    write("recipe.yaml", text);
    return load_recipe((folder / "recipe.yaml").string());
  }
  std::string refusal(const std::string& text) const {
    try {
      recipe(text);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return {};
  }
};

inline std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

}  // namespace ensonify::test
