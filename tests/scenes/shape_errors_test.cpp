#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "ensonify/core/error.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene.hpp"
#include "mesh_files.hpp"

/// What a scene may not ask of a shape, and how growth goes with the rest of an object.
namespace ensonify {
namespace {

using namespace ensonify::testing;
using ::testing::HasSubstr;

Scene load(const std::string& object) {
  const ScratchFolder scratch;
  scratch.write("box.obj", box_obj());
  return load_scene(scratch
                        .write("place.yaml",
                               "bounds: {min: [-5, -5, -6], max: [5, 5, 0]}\n"
                               "navigable: {min: [-4, -4, -4], max: [4, 4, -1]}\n"
                               "seabed: {shape: flat, depth_m: 5, material: sand}\n"
                               "objects:\n  - {name: it, material: rock, " +
                                   object + "}\n")
                        .string());
}

struct Fault {
  std::string object, why;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.object; }

/// "[x, y rest], ..." of a zigzag that moves on along y.
std::string many_points(int count, const std::string& rest = "") {
  std::ostringstream list;
  for (int i = 0; i < count; ++i) list << "[" << 1 + i % 2 << ", " << i << rest << "], ";
  return list.str();
}

class ShapeFault : public ::testing::TestWithParam<Fault> {};

TEST_P(ShapeFault, IsRefusedWithItsPlaceAndRule) {
  try {
    load(GetParam().object);
    ADD_FAILURE() << "was taken";
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr(GetParam().why));
    EXPECT_THAT(e.what(), HasSubstr("place.yaml:5: objects[0]"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, ShapeFault,
    ::testing::Values(
        Fault{"shape: extrusion, height_m: 1, profile: [[0, 0], [1, 1], [1, 0], [0, 1]]", "crosses"},
        Fault{"shape: extrusion, height_m: 1, profile: [[0, 0], [1, 1]]", "list of 3 to 1000 entries"},
        Fault{"shape: extrusion, height_m: 1, profile: [[0, 0], [1, .nan], [1, 0]]", "entry 1 must be"},
        Fault{"shape: extrusion, height_m: 1, profile: [[0, 0], [1, 1, 1], [1, 0]]", "entry 1 must be"},
        Fault{"shape: extrusion, height_m: 1, profile: [0, 1, 2]", "entry 0 must be"},
        Fault{"shape: extrusion, profile: [[0, 0], [1, 1], [1, 0]]", "needs the key 'height_m'"},
        Fault{"shape: lathe, profile: [[0.5, 0], [-0.1, 1]]", "radii"},
        Fault{"shape: lathe, profile: [[0.5, 0], [0, 1], [0.5, 2]]", "radii"},
        Fault{"shape: lathe, ring: true, profile: [[0, 0], [1, 0], [1, 1]]", "a ring's radii"},
        Fault{"shape: lathe, profile: [[0, 0], [1, 2], [0.2, 0.1], [0, 1]]", "crosses"},
        Fault{"shape: lathe, segments: 1024, profile: [" + many_points(999) + "[0, 2000]]", "gives 2.05e+06 triangles"},
        Fault{"shape: cable, radius_m: 0.1, length_m: 3, pieces: 9999, segments: 200", "gives 4e+06 triangles"},
        Fault{"shape: pipe, radius_m: 0.01, segments: 256, wall_m: 0.005, points: [[-1, 0, 0], " +
                  many_points(400, ", 0") + "[0, 9000, 0]]",
              "triangles"},
        Fault{"shape: torus, major_radius_m: 1, tube_radius_m: 1", "below major_radius_m"},
        Fault{"shape: torus, major_radius_m: 1, tube_radius_m: 0.1, segments: 100000", "must lie in"},
        Fault{"shape: pipe, radius_m: 0.5, points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]", "no room at point 1"},
        Fault{"shape: pipe, radius_m: 0.1, points: [[0, 0, 0], [1, 0, 0], [1, 0, 0]]", "points 1 and 2 coincide"},
        Fault{"shape: pipe, radius_m: 0.1, length_m: 2, points: [[0, 0, 0], [1, 0, 0]]", "either length_m or points"},
        Fault{"shape: pipe, radius_m: 0.1, length_m: 2, wall_m: 0.1", "must lie in"},
        Fault{"shape: pipe, radius_m: 0.1, length_m: 9000, flange_spacing_m: 0.1", "more than 1000 flanges"},
        Fault{"shape: chain, link_length_m: 0.01, length_m: 5000", "links"},
        Fault{"shape: chain, link_length_m: 0.3, wire_radius_m: 0.1, length_m: 5", "finds no room"},
        Fault{"shape: cable, radius_m: 0.1, start: [0, 0, 0], end: [0, 0, -3], sag_m: 1", "horizontal distance"},
        Fault{"shape: cable, radius_m: 0.1, start: [0, 0, 0], end: [0, 0, 0]", "apart from start"},
        Fault{"shape: sheet_pile_wall, length_m: 9000, height_m: 2, pitch_m: 0.3", "gives 3e+04 piles"},
        Fault{"shape: tyre, rim_radius_m: 0.5", "rim_radius_m"}, Fault{"shape: jacket, height_m: 9", "base_width_m"},
        Fault{"shape: jacket, height_m: 9, base_width_m: 4, braces: z", "must be one of"},
        Fault{"shape: ship, length_m: 80, draft_m: 9", "below depth_m"},
        Fault{"shape: ship, length_m: 80, damage: 2", "must lie in"}, Fault{"shape: ship, lenght_m: 80", "length_m"},
        Fault{"shape: debris_scatter, pieces: 3, area_m: [0, 0, 1, 1], kinds: [tire]", "'tire' is none of"},
        Fault{"shape: trash_rack, width_m: 0.2, height_m: 3", "no room for a bar"},
        Fault{"shape: box, length_m: 90, width_m: 90, height_m: 2, growth: {thickness_m: 0.01}", "enlarge patch_m"},
        Fault{"shape: sphere, radius_m: 1, growth: {thikness_m: 0.1}", "thickness_m"},
        Fault{"shape: sphere, radius_m: 1, growth: {thickness_m: 0.1, wobble: 1}", "unknown key"}));

TEST(ShapeGrowth, ComesBeforeThePoseAndRestsOnTheSeabed) {
  const Scene scene =
      load("shape: sphere, radius_m: 0.5, pose: [1, 1, 0], on_seabed: true, growth: {thickness_m: 0.1}");
  const Instance& ball = scene.instances.at(1);
  const auto box = bounding_box_m(scene.meshes.at(static_cast<std::size_t>(ball.mesh)), ball.T_world_object);
  EXPECT_NEAR(box.min().z(), -5, 1e-5);
  EXPECT_GT(box.sizes().maxCoeff(), 1.02);
  EXPECT_LE(box.sizes().maxCoeff(), 1.2);
}

TEST(ShapeGrowth, GrowsOnMeshFilesToo) {
  const Scene clean = load("mesh: box.obj");
  const Scene grown = load("mesh: box.obj, growth: {thickness_m: 0.05, patch_m: 0.3}");
  const TriangleMesh& before = clean.meshes.at(static_cast<std::size_t>(clean.instances.at(1).mesh));
  const TriangleMesh& after = grown.meshes.at(static_cast<std::size_t>(grown.instances.at(1).mesh));
  EXPECT_EQ(unpaired_edges(after), 0u);
  EXPECT_GT(enclosed_volume_m3(after), 1.01 * enclosed_volume_m3(before));
}

}  // namespace
}  // namespace ensonify
