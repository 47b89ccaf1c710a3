// A box in the test tank: the pixels where image sources in the walls put its ghosts carry the label of multipath.
#include <gtest/gtest.h>

#include <algorithm>

#include "ensonify/generators/form_images.hpp"
#include "support/image_source.hpp"
#include "support/meshes.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr auto multipath_label = static_cast<std::uint8_t>(PixelLabel::multipath);

/// The tank's four walls, as mirrors of glass or as they are bundled, and a rusty box; or the box alone.
Scene tank_with_box(bool walls, bool of_glass) {
  Scene scene = load_scene("test_tank");
  std::erase_if(scene.instances, [&](const Instance& i) { return !walls || i.name.rfind("wall_", 0) != 0; });
  scene.materials.push_back({"glass", -35.0, 14.6, 1100.0, "bundled table"});
  const int glass = static_cast<int>(scene.materials.size()) - 1;
  for (Instance& instance : scene.instances) instance.material = of_glass ? glass : instance.material;
  scene.materials.push_back({"steel_rusty", -15.0, -2.0, 25.0, "bundled table"});
  scene.meshes.push_back(box_mesh({1.2F, 2.3F, -2.2F}, {1.8F, 2.9F, -1.3F}));
  Instance box;
  box.name = "box";
  box.mesh = static_cast<int>(scene.meshes.size()) - 1;
  box.material = glass + 1;
  scene.instances.push_back(box);
  return scene;
}

/// Points of the box's upright faces, some 8 mm apart.
std::vector<Vec3> box_points() {
  std::vector<Vec3> points;
  for (int i = 0; i <= 80; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const double a = i / 80.0;
      const double z = -2.2 + 0.9 * j / 60.0;
      points.insert(
          points.end(),
          {{1.2, 2.3 + 0.6 * a, z}, {1.8, 2.3 + 0.6 * a, z}, {1.2 + 0.6 * a, 2.3, z}, {1.2 + 0.6 * a, 2.9, z}});
    }
  }
  return points;
}

PingImages ping_in(const Scene& scene, const SonarModel& sonar, const Pose& T_world_sonar) {
  const RayScene rays(scene);
  ImageSettings settings;
  settings.noise = {"test", {Multipath<double>{0, 2, 1}, CoherentSpeckle<double>{}, ReceiverNoise<double>{-24, -63}}};
  const Ping ping = PingTracer(rays, sonar, scene.water).trace(T_world_sonar, trace_options(settings.noise, false));
  return form_images(Receiver(sonar), ping, settings, {.T_world_sonar = T_world_sonar});
}

bool labelled_near(const Image2<std::uint8_t>& labels, const Ghost& ghost, std::uint8_t label) {
  for (int bin = std::max(ghost.bin - 1, 0); bin <= std::min(ghost.bin + 1, labels.rows() - 1); ++bin) {
    for (int beam = std::max(ghost.beam - 1, 0); beam <= std::min(ghost.beam + 1, labels.columns() - 1); ++beam) {
      if (labels(bin, beam) == label) return true;
    }
  }
  return false;
}

TEST(GhostLabels, ABoxInTheTankHasGhostsAndNoneInOpenWater) {
  const SonarModel sonar = load_sonar("oculus_m1200d_hf", {{}, 8.0, {}});
  const std::vector<Mirror> walls{
      {{3.5, 0, 0}, {-1, 0, 0}}, {{-3.5, 0, 0}, {1, 0, 0}}, {{0, 3.5, 0}, {0, -1, 0}}, {{0, -3.5, 0}, {0, 1, 0}}};
  const std::vector<Vec3> points = box_points();
  for (const bool of_glass : {true, false}) {
    const Scene tank = tank_with_box(true, of_glass);
    const RayScene rays(tank);
    for (const Pose& pose :
         {pose_from_xyz_rpy({-1.5, 2.2, -1.7}, 0, 0.02, 0.35), pose_from_xyz_rpy({-2.0, 2.4, -1.75}, 0, 0, 0.3),
          pose_from_xyz_rpy({2.4, -1.0, -1.7}, 0, 0, 1.31)}) {
      const PingImages images = ping_in(tank, sonar, pose);
      std::vector<Ghost> ghosts;
      for (const Mirror& mirror : walls) {
        for (const Ghost& g : ghosts_of(rays, mirror, points, sonar.geometry, pose)) {
          // Where the direct echo is seen, a pixel may rightly be that.
          if (images.mask(g.bin, g.beam) == 0) ghosts.push_back(g);
        }
      }
      ASSERT_GT(ghosts.size(), 100u);
      const auto found = std::count_if(ghosts.begin(), ghosts.end(), [&](const Ghost& g) {
        return labelled_near(images.labels, g, multipath_label);
      });
      const double labelled = static_cast<double>(found) / static_cast<double>(ghosts.size());
      const auto all = std::count(images.labels.pixels().begin(), images.labels.pixels().end(), multipath_label);
      std::printf("%s walls: %.2f %% of %zu ghosts labelled; the label is on %.1f %% of the image\n",
                  of_glass ? "glass" : "concrete", 100.0 * labelled, ghosts.size(),
                  100.0 * static_cast<double>(all) / static_cast<double>(images.labels.size()));
      EXPECT_GE(labelled, 0.95);
      EXPECT_LT(static_cast<double>(all), 0.5 * static_cast<double>(images.labels.size()));

      const PingImages alone = ping_in(tank_with_box(false, of_glass), sonar, pose);
      EXPECT_EQ(std::count(alone.labels.pixels().begin(), alone.labels.pixels().end(), multipath_label), 0);
    }
  }
}

}  // namespace
}  // namespace ensonify
