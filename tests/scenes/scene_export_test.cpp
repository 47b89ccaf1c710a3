#include "ensonify/scenes/scene_export.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_import.hpp"
#include "ensonify/scenes/mesh_measure.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

class SceneExport : public testing::TestWithParam<std::string> {
 protected:
  fs::path file = fs::temp_directory_path() / ("ensonify_export_" + std::to_string(::getpid()) + GetParam());
  void TearDown() override { fs::remove(file); }
};

Eigen::AlignedBox3d extent_of(const Scene& scene) {
  Eigen::AlignedBox3d extent;
  for (const Instance& i : scene.instances) {
    if (i.obstacle) extent.extend(bounding_box_m(scene.meshes[static_cast<std::size_t>(i.mesh)], i.T_world_object));
  }
  return extent;
}

// What is read back encloses the same volume in the same place: transforms, instances, units and axes are kept.
TEST_P(SceneExport, ReadsBackTheSame) {
  const Scene scene = load_scene("marina", 1);
  const std::vector<std::uint8_t> bytes = export_scene(scene, GetParam());
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  std::vector<std::string> warnings;
  const TriangleMesh back = import_mesh(file, {}, warnings);

  double volume_m3 = 0;
  std::size_t triangles = 0;
  for (const Instance& i : scene.instances) {
    if (!i.obstacle) continue;
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(i.mesh)];
    volume_m3 += enclosed_volume_m3(mesh) * i.T_world_object.linear().determinant();
    triangles += mesh.triangles.size();
  }
  EXPECT_EQ(back.triangles.size(), triangles);
  EXPECT_NEAR(enclosed_volume_m3(back), volume_m3, 1e-3 * volume_m3);
  const Eigen::AlignedBox3d extent = extent_of(scene), read = bounding_box_m(back);
  EXPECT_LT((read.min() - extent.min()).norm(), 1e-3);
  EXPECT_LT((read.max() - extent.max()).norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Formats, SceneExport, testing::Values(".glb", ".obj", ".ply", ".stl"),
                         [](const auto& format) { return format.param.substr(1); });

TEST(SceneExportFormats, ObjHasNoSeaSurfaceUnlessAsked) {
  const Scene scene = load_scene("marina");
  EXPECT_LT(export_scene(scene, ".stl").size(), export_scene(scene, ".stl", true).size());
}

TEST(SceneExportFormats, AnotherIsRefused) { EXPECT_THROW(export_scene(load_scene("test_tank"), ".fbx"), ConfigError); }

}  // namespace
}  // namespace ensonify
