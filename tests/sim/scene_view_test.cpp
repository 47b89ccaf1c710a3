#include "ensonify/sim/scene_view.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numbers>

#include "support/meshes.hpp"

namespace ensonify {
namespace {

/// A red box on a grey floor, with the sea surface above.
Scene box_scene() {
  Scene scene;
  Material red, grey, blue;
  red.colour = {1, 0, 0};
  grey.colour = {0.5f, 0.5f, 0.5f};
  blue.colour = {0, 0, 1};
  scene.materials = {red, grey, blue};
  scene.meshes = {test::box_mesh({1, 2, -5}, {3, 3, -3}), test::floor_mesh(-5, 20), test::floor_mesh(0, 20)};
  scene.instances = {{"box", 0, 0, Eigen::Affine3d::Identity(), true},
                     {"floor", 1, 1, Eigen::Affine3d::Identity(), true},
                     {"water", 2, 2, Eigen::Affine3d::Identity(), false}};
  scene.bounds_m = {Vec3(-4, -4, -5.5), Vec3(4, 4, 0)};
  scene.navigable_m = {Vec3(-4, -3, -4), Vec3(4, 1, 0)};
  return scene;
}

bool is_red(const Rgb& p) { return p.red > 60 && p.green < 20 && p.blue < 20; }

struct Extent {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

Extent red_extent(const Image2<Rgb>& picture) {
  Extent e;
  for (int r = 0; r < picture.rows(); ++r) {
    for (int c = 0; c < picture.columns(); ++c) {
      if (!is_red(picture(r, c))) continue;
      e.left = std::min(e.left, c), e.right = std::max(e.right, c);
      e.top = std::min(e.top, r), e.bottom = std::max(e.bottom, r);
    }
  }
  return e;
}

// Plan, 8 m over 160 pixels, north up: x 1..3 is columns 100..139, y 2..3 rows 20..39. The outline takes a third of a
// pixel. The sea surface above the box is not drawn.
TEST(SceneView, PlanIsToScale) {
  const Scene scene = box_scene();
  const Image2<Rgb> picture = draw_scene(scene, plan_camera(scene), 160, 160);
  const Extent e = red_extent(picture);
  EXPECT_NEAR(e.left, 100, 1);
  EXPECT_NEAR(e.right, 139, 1);
  EXPECT_NEAR(e.top, 20, 1);
  EXPECT_NEAR(e.bottom, 39, 1);
}

// From the south, 5.5 m of height about z = -2.75 over 110 pixels: z -3..-5 is rows 60..99.
TEST(SceneView, SideIsToScale) {
  const Scene scene = box_scene();
  const Extent e = red_extent(draw_scene(scene, side_camera(scene), 160, 110));
  EXPECT_NEAR(e.left, 100, 1);
  EXPECT_NEAR(e.right, 139, 1);
  EXPECT_NEAR(e.top, 60, 1);
  EXPECT_NEAR(e.bottom, 99, 1);
}

// A wall south of the navigable water hides nothing.
TEST(SceneView, SideIsASection) {
  Scene scene = box_scene();
  const Image2<Rgb> open = draw_scene(scene, side_camera(scene), 80, 55);
  scene.meshes.push_back(test::box_mesh({-4, -3.8f, -5}, {4, -3.2f, 0}));
  scene.instances.push_back({"wall", 3, 1, Eigen::Affine3d::Identity(), true});
  const Extent with = red_extent(draw_scene(scene, side_camera(scene), 80, 55)), without = red_extent(open);
  EXPECT_EQ(with.left, without.left);
  EXPECT_EQ(with.top, without.top);
  EXPECT_EQ(with.bottom, without.bottom);
}

// A pinhole at 10 m before a face of 2 x 1 m, 60 deg across 200 pixels: 2 / (2 * 10 tan 30) * 200 = 34.6 pixels wide.
TEST(SceneView, PerspectiveIsAPinhole) {
  const Scene scene = box_scene();
  const Camera camera{pose_from_xyz_rpy({2, -8, -4}, 0, 0, std::numbers::pi / 2), 0, radians(60.0)};
  const Extent e = red_extent(draw_scene(scene, camera, 200, 200));
  EXPECT_NEAR(e.right - e.left + 1, 34.6, 1.5);
  EXPECT_NEAR(0.5 * (e.left + e.right), 99.5, 1);
}

TEST(SceneView, ObliqueCameraIsFilledByWhatIsThere) {
  const Scene scene = box_scene();
  const Eigen::AlignedBox3d solid(Vec3(-4, -4, -5), Vec3(4, 4, -3));  // the floor within the bounds, and the box
  for (const double azimuth : {-2.0, 0.0, 1.3}) {
    const double aspect = 1.5;
    const Camera camera = oblique_camera(scene, azimuth, 0.6, aspect);
    double widest = 0;
    for (int c = 0; c < 8; ++c) {
      const Vec3 corner = solid.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
      const Vec3 seen = camera.T_world_camera.inverse() * corner;
      const double half = std::tan(0.5 * camera.field_of_view_rad);
      widest = std::max({widest, std::abs(seen.y() / seen.x()) / half, std::abs(seen.z() / seen.x()) / half * aspect});
    }
    EXPECT_LT(widest, 1.0);
    EXPECT_GT(widest, 0.9);
  }
}

// Next to a wall less of the sky is open: the floor is darker there than far away.
TEST(SceneView, CornersAreDarker) {
  const Scene scene = box_scene();
  const Image2<Rgb> picture = draw_scene(scene, plan_camera(scene), 160, 160);
  const auto mean_red = [&](int row, int column) {
    double sum = 0;
    for (int r = row; r < row + 4; ++r) {
      for (int c = column; c < column + 20; ++c) sum += picture(r, c).red;
    }
    return sum / 80;
  };
  EXPECT_LT(mean_red(42, 110), mean_red(120, 30) - 5);
}

TEST(SceneView, SameBitsForAnyNumberOfThreads) {
  const Scene scene = box_scene();
  const Camera camera = oblique_camera(scene, 0.3, 0.5, 1.5);
  const auto draw = [&](int threads) {
    return tbb::task_arena(threads).execute([&] { return draw_scene(scene, camera, 90, 60); });
  };
  EXPECT_EQ(draw(1), draw(4));
}

}  // namespace
}  // namespace ensonify
