#include "ensonify/scenes/mesh_import.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ensonify/core/error.hpp"
#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/mesh_measure.hpp"
#include "mesh_files.hpp"
#include "support/test_folders.hpp"

namespace ensonify {
namespace {

using namespace ensonify::testing;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

struct Imported {
  TriangleMesh mesh;
  Eigen::AlignedBox3d box_m;
  std::vector<std::string> warnings;
};

Imported import_file(const fs::path& file, const MeshImportOptions& options = {}) {
  Imported result;
  result.mesh = import_mesh(file, options, result.warnings);
  result.box_m = bounding_box_m(result.mesh);
  return result;
}

void expect_box(const Imported& imported, const Vec3& low_m, const Vec3& high_m) {
  EXPECT_EQ(imported.mesh.vertices_m.size(), 8u) << "not welded";
  EXPECT_EQ(imported.mesh.triangles.size(), 12u);
  EXPECT_EQ(unpaired_edges(imported.mesh), 0u);
  const double volume = (high_m - low_m).prod();
  EXPECT_NEAR(enclosed_volume_m3(imported.mesh), volume, 1e-4 * volume) << "turned inside out";
  EXPECT_LT((imported.box_m.min() - low_m).norm(), 1e-5) << imported.box_m.min().transpose();
  EXPECT_LT((imported.box_m.max() - high_m).norm(), 1e-5) << imported.box_m.max().transpose();
}

/// The box with its corner at y = `north_m`.
std::string moved_box_obj(float north_m) {
  std::string text;
  for (const auto& c : box_corners) text += fmt::format("v {} {} {}\n", c[0], c[1] + north_m, c[2]);
  for (const auto& f : box_faces) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
  return text;
}

void expect_refused(const fs::path& file, const std::string& why = "") {
  try {
    import_file(file);
    ADD_FAILURE() << file << " was taken";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr(file.string()));
    EXPECT_THAT(e.what(), HasSubstr(why));
  }
}

const Vec3 origin = Vec3::Zero();
const Vec3 one_two_three(1, 2, 3);

TEST(MeshImport, ReadsFormatsWithoutAnAxisAsZUpMetres) {
  const ScratchFolder scratch;
  expect_box(import_file(scratch.write("box.obj", box_obj())), origin, one_two_three);
  expect_box(import_file(scratch.write("box.ply", box_ply())), origin, one_two_three);
  expect_box(import_file(scratch.write("binary.ply", box_binary_ply())), origin, one_two_three);
  expect_box(import_file(scratch.write("text.stl", box_stl_text())), origin, one_two_three);
  expect_box(import_file(scratch.write("binary.STL", box_stl_binary())), origin, one_two_three);
}

TEST(MeshImport, OptionsGiveUnitScaleAndAxis) {
  const ScratchFolder scratch;
  const fs::path file = scratch.write("box.obj", box_obj());
  expect_box(import_file(file, {.scale = 2, .unit_m = 0.01, .up_axis = {}}), origin, 0.02 * one_two_three);
  expect_box(import_file(file, {.scale = 1, .unit_m = {}, .up_axis = UpAxis::y}), {0, -3, 0}, {1, 0, 2});
  expect_box(import_file(file, {.scale = 1, .unit_m = {}, .up_axis = UpAxis::x}), {-2, -3, 0}, {0, 0, 1});
}

TEST(MeshImport, ColladaAppliesUnitAxisAndNodeTransformOnce) {
  const ScratchFolder scratch;
  const std::string centimetres = R"(<unit name="centimeter" meter="0.01"/>)";
  expect_box(import_file(scratch.write("z.dae", box_dae("<up_axis>Z_UP</up_axis>", ""))), origin, one_two_three);
  expect_box(import_file(scratch.write("y.dae", box_dae("<up_axis>Y_UP</up_axis>", ""))), {0, -3, 0}, {1, 0, 2});
  expect_box(import_file(scratch.write("none.dae", box_dae("", ""))), {0, -3, 0}, {1, 0, 2});  // Y_UP by definition
  expect_box(import_file(scratch.write("x.dae", box_dae("<up_axis>X_UP</up_axis>", ""))), {-2, -3, 0}, {0, 0, 1});
  expect_box(import_file(scratch.write("cm.dae", box_dae(centimetres + "<up_axis>Z_UP</up_axis>", ""))), origin,
             0.01 * one_two_three);
  const std::string moved = "<translate>100 0 0</translate><rotate>0 0 1 90</rotate>";
  expect_box(import_file(scratch.write("moved.dae", box_dae(centimetres + "<up_axis>Z_UP</up_axis>", moved))),
             {0.98, 0, 0}, {1.00, 0.01, 0.03});
  expect_box(import_file(scratch.write("moved_y.dae", box_dae(centimetres + "<up_axis>Y_UP</up_axis>", moved))),
             {0.98, -0.03, 0}, {1.00, 0, 0.01});
}

TEST(MeshImport, ColladaOptionsReplaceWhatTheFileSays) {
  const ScratchFolder scratch;
  const fs::path file =
      scratch.write("box.dae", box_dae(R"(<unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis>)", ""));
  expect_box(import_file(file, {.scale = 1, .unit_m = 1.0, .up_axis = UpAxis::z}), origin, one_two_three);
}

TEST(MeshImport, MirroredNodesStayTurnedOutward) {
  const ScratchFolder scratch;
  expect_box(import_file(scratch.write("m.dae", box_dae("<up_axis>Z_UP</up_axis>", "<scale>-1 1 1</scale>"))),
             {-1, 0, 0}, {0, 2, 3});
}

TEST(MeshImport, GltfHasYUpAndTakesItsBufferFromBeside) {
  const ScratchFolder scratch;
  scratch.write("box.bin", box_gltf_buffer());
  expect_box(import_file(scratch.write("box.gltf", box_gltf("box.bin"))), {0, -3, 0}, {1, 0, 2});
  const std::string moved = R"([{"children":[1],"scale":[2,2,2]},{"mesh":0,"translation":[0,5,0]}])";
  expect_box(import_file(scratch.write("moved.gltf", box_gltf("box.bin", moved))), {0, -6, 10}, {2, 0, 14});
}

TEST(MeshImport, WarnsOfMillimetresUntilTheUnitIsSaid) {
  const ScratchFolder scratch;
  const fs::path file = scratch.write("box.stl", box_stl_binary(1000));
  const Imported odd = import_file(file);
  ASSERT_EQ(odd.warnings.size(), 1u);
  EXPECT_THAT(odd.warnings[0], HasSubstr("`unit: mm`"));
  EXPECT_THAT(odd.warnings[0], HasSubstr("box.stl"));
  expect_box(import_file(file, {.scale = 1, .unit_m = 0.001, .up_axis = {}}), origin, one_two_three);
  EXPECT_TRUE(import_file(file, {.scale = 1, .unit_m = 1.0, .up_axis = {}}).warnings.empty());
}

TEST(MeshImport, DropsFlatAndInfiniteTrianglesWithAWarning) {
  const ScratchFolder scratch;
  const Imported imported =
      import_file(scratch.write("box.obj", box_obj() + "v inf 0 0\nv nan 1 1\nf 1 1 2\nf 1 2 9\nf 2 3 10\n"));
  EXPECT_EQ(imported.mesh.triangles.size(), 12u);
  ASSERT_EQ(imported.warnings.size(), 2u);
  EXPECT_THAT(imported.warnings[0], HasSubstr("1 of 15 triangles have no area"));
  EXPECT_THAT(imported.warnings[1], HasSubstr("2 of 15 triangles are left out"));
}

// A northing of UTM: 4 200 000 m.
TEST(MeshImport, SaysThatAGeoreferencedMeshIsTooFarNotFlat) {
  const ScratchFolder scratch;
  const fs::path far = scratch.write("utm.obj", moved_box_obj(4.2e6F));
  expect_refused(far, "12 of 12 triangles lie further than 1000 km from the origin");
  expect_refused(far, "subtract an offset");
}

// From 16384 m on neighbouring numbers of single precision are 2 mm apart, below that 1 mm.
TEST(MeshImport, WarnsWhereSinglePrecisionIsCoarserThanAMillimetre) {
  const ScratchFolder scratch;
  EXPECT_TRUE(import_file(scratch.write("near.obj", moved_box_obj(16380))).warnings.empty());
  const Imported far = import_file(scratch.write("far.obj", moved_box_obj(-16390)));
  ASSERT_EQ(far.warnings.size(), 1u);
  EXPECT_THAT(far.warnings[0], HasSubstr("coordinates of 16390 m, which single precision rounds to 2 mm"));
  EXPECT_THAT(far.warnings[0], HasSubstr("subtract an offset"));
}

TEST(MeshImport, PolygonsBecomeTriangles) {
  const ScratchFolder scratch;
  const Imported imported =
      import_file(scratch.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nl 1 2\np 3\n"));
  EXPECT_EQ(imported.mesh.triangles.size(), 2u);
}

TEST(MeshImport, RefusesWhatIsNoMesh) {
  const ScratchFolder scratch;
  expect_refused(scratch.path() / "absent.obj", "no such file");
  expect_refused(scratch.path(), "");
  expect_refused(scratch.write("box.blend", box_obj()), "use .obj");
  for (const char* extension : {"obj", "ply", "stl", "gltf", "glb", "dae"}) {
    expect_refused(scratch.write(std::string("empty.") + extension, ""), "is empty");
    expect_refused(scratch.write(std::string("garbage.") + extension, std::string(500, '\xa7') + "garbage\n\0\xff"));
    expect_refused(scratch.write(std::string("text.") + extension, "Lorem ipsum dolor sit amet\n"));
  }
  expect_refused(scratch.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
  expect_refused(scratch.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "no triangle");
  expect_refused(scratch.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999\n"));
}

TEST(MeshImport, RefusesFacesWithoutCorners) {
  const ScratchFolder scratch;
  const std::string ply = box_ply();
  expect_refused(scratch.write("empty_face.ply", ply.substr(0, ply.rfind("3 1 7 5")) + "0\n"), "a face has no corners");
}

TEST(MeshImport, RefusesCountsBeyondTheData) {
  const ScratchFolder scratch;
  expect_refused(scratch.write("twice.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + box_ply().substr(21)));
  const auto with = [](const std::string& old_text, const std::string& new_text) {
    std::string dae = box_dae("", "");
    return dae.replace(dae.find(old_text), old_text.size(), new_text);
  };
  expect_refused(scratch.write("accessor.dae", with("count=\"8\"", "count=\"80\"")), "beyond its array");
  expect_refused(scratch.write("stride.dae", with("stride=\"3\"", "stride=\"30\"")), "beyond its array");
  expect_refused(scratch.write("array.dae", with("count=\"24\"", "count=\"-1\"")), "no whole number");
  expect_refused(scratch.write("huge.dae", with("count=\"24\"", "count=\"4000000000\"")), "larger than the file");
}

TEST(MeshImport, RefusesFilesCutShort) {
  const ScratchFolder scratch;
  const auto cut = [](const std::string& bytes, double share) {
    return bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
  };
  scratch.write("box.bin", cut(box_gltf_buffer(), 0.5));
  for (const double share : {0.2, 0.6, 0.9}) {
    expect_refused(scratch.write("cut.ply", cut(box_ply(), share)));
    expect_refused(scratch.write("binary.ply", cut(box_binary_ply(), share)));
    expect_refused(scratch.write("text.stl", cut(box_stl_text(), share)));
    expect_refused(scratch.write("binary.stl", cut(box_stl_binary(), share)));
    expect_refused(scratch.write("cut.dae", cut(box_dae("", ""), share)));
    expect_refused(scratch.write("cut.gltf", cut(box_gltf("box.bin"), share)));
  }
  expect_refused(scratch.write("whole.gltf", box_gltf("box.bin")));
}

TEST(MeshImport, RefusesFilesThatReachOutsideOrContainThemselves) {
  const ScratchFolder scratch;
  fs::create_directories(scratch.path() / "in");
  scratch.write("box.bin", box_gltf_buffer());
  expect_refused(scratch.write("in/outside.gltf", box_gltf("../box.bin")));
  expect_refused(scratch.write("device.gltf", box_gltf("/dev/zero")));

  const std::string self = R"(<instance_node url="#n"/>)";
  expect_refused(scratch.write("self.dae", box_dae("", "", self)));
  expect_refused(scratch.write("loop.gltf", box_gltf("box.bin", R"([{"children":[1],"mesh":0},{"children":[0]}])")));
  expect_refused(scratch.write("self.gltf", box_gltf("box.bin", R"([{"children":[0],"mesh":0}])")));

  std::string doubled;  // 2^40 boxes
  for (int level = 0; level < 40; ++level) {
    const std::string next = std::string(R"(<instance_node url="#d)") + std::to_string(level + 1) + R"("/>)";
    doubled += std::string("<node id=\"d") + std::to_string(level) + "\">" + next + next + "</node>";
  }
  expect_refused(scratch.write("bomb.dae", box_dae("", "", doubled + R"(<node id="d40"/>)")));
}

TEST(MeshImport, RefusesTextNestedWithoutEnd) {
  const ScratchFolder scratch;
  std::string nodes, json;
  for (int i = 0; i < 200000; ++i) {
    nodes += "<node>";
    json += "[";
  }
  expect_refused(scratch.write("deep.dae", box_dae("", "", nodes)));
  expect_refused(scratch.write("deep.gltf", json));
}

/// Reads or refuses; anything else ends the test program.
void expect_survived(const fs::path& file) {
  try {
    import_file(file);
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), HasSubstr(file.string()));
  }
}

TEST(MeshImport, SurvivesAnyCutAndAnyFlippedBit) {
  const ScratchFolder scratch;
  scratch.write("box.bin", box_gltf_buffer());
  const std::pair<const char*, std::string> wholes[] = {
      {"a.obj", box_obj()},           {"a.ply", box_ply()},        {"b.ply", box_binary_ply()},
      {"a.stl", box_stl_text()},      {"b.stl", box_stl_binary()}, {"a.dae", box_dae("<up_axis>Z_UP</up_axis>", "")},
      {"a.gltf", box_gltf("box.bin")}};
  for (const auto& [name, whole] : wholes) {
    for (std::size_t part = 0; part < 16; ++part) {
      expect_survived(scratch.write(name, whole.substr(0, whole.size() * part / 16)));
    }
    const std::size_t step = 1 + whole.size() / 80;
    for (std::size_t i = 0; i < whole.size(); i += step) {
      std::string flipped = whole;
      flipped[i] = static_cast<char>(flipped[i] ^ 1 << i % 8);
      expect_survived(scratch.write(name, flipped));
    }
  }
}

TEST(MeshImport, BoundsWhatItsParserIsSlowAtOrTrusts) {
  const ScratchFolder scratch;
  std::string comments = box_ply();
  std::string many;
  for (int i = 0; i < 90'000; ++i) many += "comment x\n";
  expect_refused(scratch.write("comments.ply", comments.insert(comments.find("element"), many)));
  for (const char* strange : {"#", "1 x 2", "1,2", "<![CDATA[1 #]]>", "&#35;"}) {  // waits for ever, taking memory
    std::string indices = box_dae("", "");
    expect_refused(scratch.write("indices.dae", indices.insert(indices.find("<p>") + 3, strange)), "whole numbers");
  }
  scratch.write("box.bin", box_gltf_buffer());
  std::string strided = box_gltf("box.bin");
  expect_refused(
      scratch.write("stride.gltf", strided.insert(strided.find("\"byteLength\":96"), "\"byteStride\":2147483648,")));
}

struct RealMesh {
  const char* file;
  Vec3 low_m, high_m;
  std::size_t triangles;
};

TEST(MeshImport, ReadsRealRobots) {
  const fs::path folder = shared_folder() / "meshes";
  if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is absent; set ENSONIFY_SHARED";
  // The glider went through MeshLab, which marks every file Y_UP; its wings span x, its hull lies along y and its tail
  // fin stands along z, 3.1 m long as drawn.
  const RealMesh meshes[] = {{"slocum_glider.dae", {-1.186, -1.616, -0.220}, {1.186, 1.500, 0.436}, 1570},
                             {"workhorse_navigator.dae", {-0.1126, -0.1126, -0.1222}, {0.1126, 0.1126, 0.1222}, 3088},
                             {"rexrov.stl", {-1.314, -0.756, -0.797}, {1.297, 0.756, 0.801}, 288}};
  for (const RealMesh& real : meshes) {
    const Imported imported = import_file(folder / real.file);
    EXPECT_LT((imported.box_m.min() - real.low_m).norm(), 2e-3) << real.file;
    EXPECT_LT((imported.box_m.max() - real.high_m).norm(), 2e-3) << real.file;
    EXPECT_EQ(imported.mesh.triangles.size(), real.triangles) << real.file;
    EXPECT_GT(enclosed_volume_m3(imported.mesh), 0) << real.file;
    const bool meshlab = real.file == std::string("slocum_glider.dae");
    EXPECT_EQ(imported.warnings.size(), meshlab ? 1u : 0u) << real.file;
  }
}

}  // namespace
}  // namespace ensonify
