#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene.hpp"
#include "mesh_files.hpp"

namespace ensonify {
namespace {

using namespace ensonify::testing;
using ::testing::HasSubstr;

const std::string place = R"(
bounds: {min: [-5, -5, -6], max: [5, 5, 0]}
navigable: {min: [-4, -4, -4], max: [4, 4, -1]}
)";

Scene load(const std::string& yaml, std::uint64_t layout = 0) {
  const ScratchFolder scratch;
  scratch.write("box.obj", box_obj());
  scratch.write("broken.dae", "<COLLADA>");
  return load_scene(scratch.write("place.yaml", place + yaml).string(), layout);
}

void expect_config_error(const std::string& yaml, const std::string& why, const std::string& where = "place.yaml:") {
  try {
    load(yaml);
    ADD_FAILURE() << "was taken: " << yaml;
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr(why));
    EXPECT_THAT(e.what(), HasSubstr(where));
  }
}

const std::string rock = "objects:\n  - {name: rock, shape: sphere, radius_m: 1, material: rock";

TEST(SceneLoader, ReadsAPlace) {
  const Scene scene = load(
      "title: A ball\nwater: {temperature_c: 4, salinity_psu: 0, depth_m: 3, ph: 7}\ngrid_resolution_m: 0.2\n"
      "waypoints: [[0, 1, -2, 0, 0, 90]]\n" +
      rock + ", pose: [1, 2, -3, 0, 0, 90]}\n");
  EXPECT_EQ(scene.name, "place");
  EXPECT_EQ(scene.title, "A ball");
  EXPECT_EQ(scene.water.temperature_c, 4);
  EXPECT_EQ(scene.grid_resolution_m, 0.2);
  ASSERT_EQ(scene.waypoints.size(), 1u);
  EXPECT_LT((scene.waypoints[0] * Vec3::UnitX() - Vec3(0, 2, -2)).norm(), 1e-9);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "rock");
  EXPECT_EQ(scene.materials.at(static_cast<std::size_t>(scene.instances[0].material)).name, "rock");
  EXPECT_LT((scene.instances[0].T_world_object.translation() - Vec3(1, 2, -3)).norm(), 1e-9);
}

TEST(SceneLoader, SurfaceEchoesButIsNoObstacle) {
  const Scene scene = load("surface: {roughness_m: 0.01}\nseabed: {shape: flat, depth_m: 5, material: sand}\n");
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_TRUE(scene.instances[0].obstacle);
  EXPECT_FALSE(scene.instances[1].obstacle);
  EXPECT_EQ(load("surface: none\n" + rock + "}\n").instances.size(), 1u);
}

TEST(SceneLoader, ObjectsRestOnTheSeabed) {
  const Scene scene = load("seabed: {shape: flat, depth_m: 5, material: sand}\n" + rock +
                           ", pose: [1, 1, 0.5, 20, 30, 40], on_seabed: true}\n");
  const Instance& ball = scene.instances.at(1);
  const auto box = bounding_box_m(scene.meshes[static_cast<std::size_t>(ball.mesh)], ball.T_world_object);
  EXPECT_NEAR(box.min().z(), -4.5, 1e-5);
}

TEST(SceneLoader, CopiesOfAMeshFileShareOneMesh) {
  const Scene scene = load(
      "objects:\n"
      "  - {name: a, mesh: box.obj, material: rock, count: 3, step_m: [1, 0, 0]}\n"
      "  - {name: b, mesh: box.obj, material: sand}\n"
      "  - {name: c, mesh: box.obj, unit: cm, material: sand}\n");
  EXPECT_EQ(scene.meshes.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.instances[2].name, "a_2");
  EXPECT_EQ(scene.instances[2].T_world_object.translation().x(), 2);
  EXPECT_EQ(scene.instances[2].mesh, scene.instances[3].mesh);
}

TEST(SceneLoader, PlaceMayDefineAndReplaceMaterials) {
  const Scene scene = load("materials: {rock: {lambert_db: -3}}\n" + rock + "}\n");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].lambert_db, -3);
}

TEST(SceneLoader, DistributionsMakeTheLayout) {
  const std::string yaml = rock + ", pose: {x_m: {uniform: [-3, 3]}}, count: {choice: [1, 2, 3, 4]}}\n";
  EXPECT_EQ(load(yaml, 3).instances[0].T_world_object.matrix(), load(yaml, 3).instances[0].T_world_object.matrix());
  EXPECT_NE(load(yaml, 3).instances[0].T_world_object.matrix(), load(yaml, 4).instances[0].T_world_object.matrix());
}

TEST(SceneLoader, NamesTheNearestKeyAndTheLine) {
  expect_config_error("sebed: {shape: flat}\n" + rock + "}\n", "did you mean 'seabed'?", "place.yaml:4: sebed");
  expect_config_error("objects:\n  - {name: a, shape: sphere, radiusm: 1, material: rock}\n", "radius_m");
  expect_config_error("objects:\n  - {name: a, shape: sphere, radius_m: 1, material: rok}\n", "did you mean 'rock'?");
  expect_config_error("objects:\n  - {name: a, shape: spere, radius_m: 1, material: rock}\n", "must be one of");
  expect_config_error(rock + ", wobble: 1}\n", "unknown key");
  expect_config_error(rock + ", count: 0, wobble: 1}\n", "unknown key");
}

TEST(SceneLoader, RefusesValuesOutOfRange) {
  expect_config_error("objects:\n  - {name: a, shape: sphere, radius_m: -1, material: rock}\n", "must lie in");
  expect_config_error("objects:\n  - {name: a, shape: sphere, radius_m: .nan, material: rock}\n", "must lie in");
  expect_config_error(rock + "}\n  - {name: rock, shape: sphere, radius_m: 1, material: rock}\n", "must be unique");
  expect_config_error("waypoints: [[9, 0, -2, 0, 0, 0]]\n" + rock + "}\n", "outside navigable");
  expect_config_error("waypoints: [[0, 0, -2]]\n" + rock + "}\n", "must be [x, y, z, roll, pitch, yaw]");
  expect_config_error("waypoints: [3]\n" + rock + "}\n", "must be [x, y, z, roll, pitch, yaw]");
  expect_config_error("water: {salinity_psu: 400}\n" + rock + "}\n", "must lie in");
  expect_config_error("", "holds nothing");
  expect_config_error(rock + ", on_seabed: true}\n", "needs a seabed");
  expect_config_error(rock + ", pose: [1, 2]}\n", "must be [x, y, z]");
}

TEST(SceneLoader, RefusesPlacesThatWouldFillTheMemory) {
  expect_config_error("grid_resolution_m: 0.001\n" + rock + "}\n", "grid cells");
  expect_config_error("seabed: {shape: fractal, depth_m: 5, spacing_m: 0.001, material: sand}\n", "grid nodes");
  expect_config_error(rock + ", count: 1000000}\n", "must lie in");
  expect_config_error(
      "objects:\n  - {name: a, shape: fractal, length_m: 100, width_m: 100, spacing_m: 0.08, roughness_m: 0, material: "
      "rock, "
      "count: 1000}\n",
      "triangles");
}

TEST(SceneLoader, RefusesBoundsThatDoNotFit) {
  const ScratchFolder scratch;
  const auto refused = [&](const std::string& yaml, const std::string& why) {
    try {
      load_scene(scratch.write("place.yaml", yaml).string());
      ADD_FAILURE() << yaml;
    } catch (const ConfigError& e) {
      EXPECT_THAT(e.what(), HasSubstr(why));
    }
  };
  refused("bounds: {min: [0, 0, -2], max: [1, 1, 1]}\nnavigable: {min: [0, 0, -2], max: [1, 1, 0]}\n", "z = 0");
  refused("bounds: {min: [0, 0, -2], max: [1, 1, 0]}\nnavigable: {min: [0, 0, -3], max: [1, 1, 0]}\n", "inside bounds");
  refused("bounds: {min: [0, 0, -2], max: [1, 0, 0]}\n", "min must be below max");
  refused("title: x\n", "needs the key 'bounds'");
  refused("[1, 2]\n", "place.yaml");
}

TEST(SceneLoader, NamesTheMeshFileAtFault) {
  expect_config_error("objects:\n  - {name: a, mesh: absent.obj, material: rock}\n", "absent.obj: no such file");
  EXPECT_THROW(load("objects:\n  - {name: a, mesh: broken.dae, material: rock}\n"), DataError);
  EXPECT_THROW(load_scene("no_such_place"), ConfigError);
}

TEST(SceneFromMesh, WidensTheBoundsByATenth) {
  const ScratchFolder scratch;
  const Scene scene = scene_from_mesh(scratch.write("box.obj", box_obj()));
  EXPECT_LT((scene.bounds_m.sizes() - 1.1 * Vec3(1, 2, 3)).norm(), 1e-6);
  EXPECT_LT((scene.bounds_m.center() - Vec3(0.5, 1, 1.5)).norm(), 1e-6);
  EXPECT_EQ(scene.instances.size(), 1u);
}

}  // namespace
}  // namespace ensonify
