/// Foreign meshes, imported as a user would, seen where they are. The sonar looks along +x from (-3, 0, z): the nearest
/// surface it can meet is that of the mesh, at a range known from its drawing. Skipped where the meshes are absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/pings.hpp"
#include "support/test_folders.hpp"

namespace ensonify::test {
namespace {

namespace fs = std::filesystem;

fs::path shared_mesh(const std::string& name) { return shared_folder() / "meshes" / name; }

float nearest_hit_m(const fs::path& mesh, double sonar_z_m) {
  const SonarModel sonar = load_sonar("oculus_m1200d_hf");
  const Ping ping = ping_of(scene_from_mesh(mesh), sonar, pose_from_xyz_rpy({-3.0, 0.0, sonar_z_m}, 0, 0, 0));
  const auto hits = ping.truth.first_hit_range_m.pixels();
  return *std::min_element(hits.begin(), hits.end());
}

struct Known {
  const char* file;
  double sonar_z_m;
  double range_m;  ///< of the nearest point
  double within_m;
};

class OwnMesh : public testing::TestWithParam<Known> {};

TEST_P(OwnMesh, IsSeenWhereItIs) {
  const fs::path mesh = shared_mesh(GetParam().file);
  if (!fs::is_regular_file(mesh)) GTEST_SKIP() << mesh << " is absent; set ENSONIFY_SHARED";
  EXPECT_NEAR(nearest_hit_m(mesh, GetParam().sonar_z_m), GetParam().range_m, GetParam().within_m);
}

INSTANTIATE_TEST_SUITE_P(Shared, OwnMesh,
                         testing::Values(
                             // A cylinder of radius 0.1126 m about z: 3 - 0.1126.
                             Known{"workhorse_navigator.dae", 0.0, 2.887, 0.005},
                             // Wings along x to 1.186 m, their tips within a hand's breadth of y = 0.1: 3 - 1.186,
                             // hypot with the tip's offset.
                             Known{"slocum_glider.dae", 0.0, 1.82, 0.02},
                             // Frame of pipes to 1.314 m forward, outermost 0.75 m aside at 24 degrees, within the fan:
                             // the nearest lie at the lower end of hypot(3 - 1.314, 0.0 .. 0.756).
                             Known{"rexrov.stl", 0.0, 1.77, 0.09}),
                         [](const auto& tested) { return fs::path(tested.param.file).stem().string(); });

}  // namespace
}  // namespace ensonify::test
