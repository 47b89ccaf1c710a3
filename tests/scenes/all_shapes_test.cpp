#include <gtest/gtest.h>

#include <map>

#include "ensonify/scenes/mesh_measure.hpp"
#include "ensonify/scenes/scene_shapes.hpp"

/// What holds for every shape that a scene may name: closed, turned outward, finite, within its extent, repeatable.
namespace ensonify {
namespace {

struct Sample {
  std::string parameters;
  Vec3 low_m, high_m;  ///< the extent the parameters promise
  bool seeded = false;
  bool open = false;
};

const std::map<std::string, Sample>& samples() {
  static const std::map<std::string, Sample> table{
      {"box", {"length_m: 1, width_m: 2, height_m: 3", {-0.5, -1, -1.5}, {0.5, 1, 1.5}}},
      {"sphere", {"radius_m: 1", {-1, -1, -1}, {1, 1, 1}}},
      {"cylinder", {"radius_m: 1, height_m: 2", {-1, -1, -1}, {1, 1, 1}}},
      {"cone", {"radius_m: 1, height_m: 2", {-1, -1, -1}, {1, 1, 1}}},
      {"plane", {"length_m: 1, width_m: 2", {-0.5, -1, 0}, {0.5, 1, 0}, false, true}},
      {"torus", {"major_radius_m: 1, tube_radius_m: 0.25", {-1.25, -1.25, -0.25}, {1.25, 1.25, 0.25}}},
      {"extrusion", {"profile: [[0, 0], [2, 0], [2, 1], [1, 0.2], [0, 1]], height_m: 2", {0, 0, -1}, {2, 1, 1}}},
      {"lathe", {"profile: [[0.5, 0], [0.3, 0.2], [0.3, 1], [0, 1.2]]", {-0.5, -0.5, 0}, {0.5, 0.5, 1.2}}},
      {"pipe",
       {"radius_m: 0.2, wall_m: 0.02, points: [[0, 0, 0], [4, 0, 0], [4, 3, 0]], flange_spacing_m: 2, bolts: 8",
        {-0.03, -0.3, -0.3},
        {4.3, 3.03, 0.3}}},
      {"cable",
       {"radius_m: 0.05, start: [0, 0, 0], end: [4, 0, 1], sag_m: 1", {-0.05, -0.05, -0.8}, {4.05, 0.05, 1.05}}},
      {"chain",
       {"link_length_m: 0.4, start: [0, 0, 0], end: [4, 1, 0], sag_m: 0.5", {-0.2, -0.2, -0.7}, {4.2, 1.2, 0.2}}},
      {"tyre", {"outer_radius_m: 0.5", {-0.5, -0.5, -0.14}, {0.5, 0.5, 0.14}}},
      {"hull", {"length_m: 8, beam_m: 2.6, draft_m: 0.8", {-4.2, -1.31, -0.81}, {4.2, 1.31, 0.61}}},
      {"ship", {"length_m: 80, damage: 0.8", {-48, -14, -16}, {48, 14, 20}, true}},
      {"boulder", {"radius_m: 0.5", {-1, -1, -1}, {1, 1, 1}, true}},
      {"fractal", {"length_m: 4, width_m: 2", {-2, -1, -1.5}, {2, 1, 1}, true}},
      {"rippled",
       {"length_m: 4, width_m: 2, ripple_height_m: 0.1, ripple_length_m: 0.5", {-2, -1, -1}, {2, 1, 0.1}, true}},
      {"pile_row",
       {"piles: 3, spacing_m: 2, length_m: 5, radius_m: 0.2, tilt_deg: 2", {-0.5, -0.5, -5.1}, {4.5, 0.5, 0.1}, true}},
      {"boulder_scatter", {"boulders: 9, area_m: [-4, -4, 4, 4], radius_m: 0.3", {-5, -5, -1}, {5, 5, 1}, true}},
      {"debris_scatter", {"pieces: 40, area_m: [-4, -4, 4, 4]", {-5, -5, -1}, {5, 5, 1.3}, true}},
      {"rubble_mound",
       {"length_m: 4, crest_width_m: 1, height_m: 2, radius_m: 0.3, rocks: 9", {-3, -6, -3}, {3, 6, 1}, true}},
      {"sheet_pile_wall",
       {"length_m: 6, height_m: 5, offset_m: {uniform: [-0.02, 0.02]}, cap_height_m: 0.6",
        {-0.1, -0.5, -5.1},
        {6.1, 0.5, 0.31},
        true}},
      {"truss", {"length_m: 6, width_m: 1", {-0.1, -0.6, -0.1}, {6.1, 0.6, 1.1}}},
      {"jacket", {"height_m: 20, base_width_m: 12, pile_radius_m: 0.3", {-8, -8, -2.5}, {8, 8, 20.1}}},
      {"stairs", {"steps: 8", {0, -0.6, 0}, {8 * 0.29, 0.6, 8 * 0.17}}},
      {"ladder", {"height_m: 3", {-0.04, -0.3, 0}, {0.04, 0.3, 3}}},
      {"trash_rack", {"width_m: 2, height_m: 3", {-1, -0.1, 0}, {1, 0.1, 3}}},
  };
  return table;
}

Assembly build(const std::string& shape, std::uint64_t seed) {
  Reader reader = Reader::from_text("{" + samples().at(shape).parameters + "}", shape);
  const RandomKey key = RandomKey::from_seed(seed);
  RandomSequence random(key);
  const ScatterGround ground{[](double, double) { return 0.0; }, {}};
  Assembly assembly = build_shape(shape, FieldSampler{reader, random}, key, ground);
  reader.finish();
  return assembly;
}

bool same_bits(const Assembly& a, const Assembly& b) {
  if (a.meshes.size() != b.meshes.size() || a.parts.size() != b.parts.size()) return false;
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    if (a.meshes[i].vertices_m != b.meshes[i].vertices_m || a.meshes[i].triangles != b.meshes[i].triangles)
      return false;
  }
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    if (a.parts[i].mesh != b.parts[i].mesh) return false;
    if (a.parts[i].T_object_part.matrix() != b.parts[i].T_object_part.matrix()) return false;
  }
  return true;
}

TEST(ShapeNames, EveryShapeHasASample) {
  for (const std::string& name : shape_names()) EXPECT_TRUE(samples().contains(name)) << name;
  EXPECT_EQ(shape_names().size(), samples().size());
}

class EveryShape : public ::testing::TestWithParam<std::string> {
 protected:
  const Sample& sample() const { return samples().at(GetParam()); }
};

TEST_P(EveryShape, PartsAreClosedAndTurnOutward) {
  const Assembly assembly = build(GetParam(), 1);
  ASSERT_FALSE(assembly.parts.empty());
  if (sample().open) return;
  for (const TriangleMesh& mesh : assembly.meshes) {
    EXPECT_EQ(unpaired_edges(mesh), 0u);
    EXPECT_GT(enclosed_volume_m3(mesh), 0.0);
  }
  for (const Part& part : assembly.parts) EXPECT_GT(part.T_object_part.linear().determinant(), 0) << "is mirrored";
}

TEST_P(EveryShape, HasNoTriangleWithoutArea) {
  for (const TriangleMesh& mesh : build(GetParam(), 1).meshes) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 pa = mesh.vertices_m.at(a).cast<double>(), pb = mesh.vertices_m.at(b).cast<double>();
      const Vec3 pc = mesh.vertices_m.at(c).cast<double>();
      ASSERT_GT((pb - pa).cross(pc - pa).norm(), 1e-12);
    }
  }
}

TEST_P(EveryShape, FillsTheExtentThatItsParametersPromise) {
  const Assembly assembly = build(GetParam(), 1);
  Eigen::AlignedBox3d box;
  for (const Part& part : assembly.parts) {
    const TriangleMesh& mesh = assembly.meshes.at(static_cast<std::size_t>(part.mesh));
    for (const Eigen::Vector3f& v : mesh.vertices_m) ASSERT_TRUE(v.allFinite());
    box.extend(bounding_box_m(mesh, part.T_object_part));
  }
  const Eigen::AlignedBox3d promised(sample().low_m - Vec3::Constant(1e-5), sample().high_m + Vec3::Constant(1e-5));
  EXPECT_TRUE(promised.contains(box)) << box.min().transpose() << " to " << box.max().transpose();
  EXPECT_GT(box.sizes().maxCoeff(), 0.5 * promised.sizes().maxCoeff());
}

TEST_P(EveryShape, SameKeySameBitsAndOtherKeyOtherBitsWhereSeeded) {
  EXPECT_TRUE(same_bits(build(GetParam(), 1), build(GetParam(), 1)));
  EXPECT_EQ(same_bits(build(GetParam(), 1), build(GetParam(), 2)), !sample().seeded);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, ::testing::ValuesIn(shape_names()),
                         [](const auto& shape) { return shape.param; });

}  // namespace
}  // namespace ensonify
