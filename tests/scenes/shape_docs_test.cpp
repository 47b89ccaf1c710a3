#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene.hpp"
#include "ensonify/scenes/scene_shapes.hpp"
#include "support/test_folders.hpp"

/// docs/shapes holds one scene a shape, which loads and shows it.
namespace ensonify {
namespace {

std::filesystem::path docs() { return source_folder() / "docs"; }

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ShapeDocs : public ::testing::TestWithParam<std::string> {};

TEST_P(ShapeDocs, ExampleLoadsAndLiesWithinItsBounds) {
  const std::filesystem::path path = docs() / "shapes" / (GetParam() + ".yaml");
  ASSERT_TRUE(std::filesystem::exists(path)) << path;
  const std::string key = GetParam() == "growth" ? "growth: {" : "shape: " + GetParam() + "\n";
  EXPECT_NE(content(path).find(key), std::string::npos);
  const Scene scene = load_scene(path.string());
  Eigen::AlignedBox3d box;
  for (const Instance& instance : scene.instances) {
    if (instance.name == "seabed") continue;
    box.extend(bounding_box_m(scene.meshes.at(static_cast<std::size_t>(instance.mesh)), instance.T_world_object));
  }
  EXPECT_TRUE(scene.bounds_m.intersects(box));
  EXPECT_GT(box.intersection(scene.bounds_m).volume(), 0.4 * box.volume());
}

TEST_P(ShapeDocs, IsDescribed) { EXPECT_NE(content(docs() / "shapes.md").find("`" + GetParam()), std::string::npos); }

std::vector<std::string> described() {
  std::vector<std::string> names = shape_names();
  names.push_back("growth");
  return names;
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapeDocs, ::testing::ValuesIn(described()),
                         [](const auto& shape) { return shape.param; });

}  // namespace
}  // namespace ensonify
