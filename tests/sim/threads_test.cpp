// The same bits from any number of threads, and from every build of the same scene.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "ensonify/core/parallel.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

/// A floor, 300 uses of one mesh (above the limit of copies: instances) and 300 of another (copied).
Scene crowd() {
  Scene scene =
      scene_of({sphere_mesh(0.25, 40, 20), box_mesh({-0.1F, -0.1F, -0.1F}, {0.1F, 0.2F, 0.3F}), floor_mesh(-2.0)});
  const Instance pattern = scene.instances[0];
  scene.instances.erase(scene.instances.begin(), scene.instances.begin() + 2);
  for (int i = 0; i < 600; ++i) {
    Instance instance = pattern;
    instance.mesh = i % 2;
    instance.T_world_object.translate(Vec3(1.5 + 8.0 * std::fmod(0.618 * i, 1.0), 5.0 * std::fmod(0.414 * i, 1.0) - 2.5,
                                           std::fmod(0.732 * i, 1.0) - 1.5));
    instance.T_world_object.rotate(Eigen::AngleAxisd(0.1 * i, Vec3(1, 1, 0.3).normalized()));
    scene.instances.push_back(instance);
  }
  return scene;
}

std::vector<Ping> pings_with(int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const Scene scene = crowd();
  const RayScene rays(scene);
  const SonarModel sonar = bare_sonar({.elevation_rays = 128});
  const PingTracer tracer(rays, sonar, scene.water);
  std::vector<Ping> pings(4);
  parallel_for(4, [&](int i) {
    pings[i] = tracer.trace(pose_from_xyz_rpy({0.1 * i, 0, 0}, 0.05 * i, 0.02 * i, 0), {.cell_truth = true});
  });
  return pings;
}

bool same_bits(const Image2<float>& a, const Image2<float>& b) {
  return a.size() == b.size() && std::memcmp(a.pixels().data(), b.pixels().data(), a.size() * sizeof(float)) == 0;
}

TEST(Threads, SameBits) {
  const std::vector<Ping> one = pings_with(1);
  ASSERT_GT(sum_of(one[0].echo.direct), 0.0);
  for (const int threads : {1, 2, 8}) {
    const std::vector<Ping> other = pings_with(threads);
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(same_bits(one[i].echo.direct, other[i].echo.direct)) << threads << " threads, ping " << i;
      EXPECT_TRUE(same_bits(one[i].truth.first_hit_range_m, other[i].truth.first_hit_range_m)) << threads;
      EXPECT_TRUE(same_bits(one[i].truth.incidence_rad, other[i].truth.incidence_rad)) << threads;
      EXPECT_EQ(one[i].truth.instance, other[i].truth.instance);
      EXPECT_EQ(one[i].truth.shadow_start_bin, other[i].truth.shadow_start_bin);
    }
  }
}

// Tracing with cell truth or without is the same ping.
TEST(Threads, CellTruthChangesNoEcho) {
  const Scene scene = crowd();
  const RayScene rays(scene);
  const SonarModel sonar = bare_sonar({.elevation_rays = 128});
  const PingTracer tracer(rays, sonar, scene.water);
  EXPECT_TRUE(same_bits(tracer.trace(Pose::Identity(), {.cell_truth = true}).echo.direct,
                        tracer.trace(Pose::Identity()).echo.direct));
}

}  // namespace
}  // namespace ensonify
