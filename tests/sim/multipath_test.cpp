// The layer as part of a ping: its bits, and the ghosts of a box in the test tank.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/sim/ray_packet.hpp"
#include "support/box_in_tank.hpp"
#include "support/image_source.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

bool same_bits(const Image2<float>& a, const Image2<float>& b) {
  return a.size() == b.size() && std::memcmp(a.pixels().data(), b.pixels().data(), a.size() * sizeof(float)) == 0;
}

TEST(Multipath, SameBitsOnAnyNumberOfThreads) {
  const Scene scene = load_scene("test_tank");
  const SonarModel sonar = load_sonar("oculus_m1200d_hf");
  const RayScene rays(scene);
  const PingTracer tracer(rays, sonar, scene.water);
  const auto pings_with = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    std::vector<Ping> pings(8);
    parallel_for(8, [&](int i) {
      pings[i] = tracer.trace(scene.waypoints[static_cast<std::size_t>(2 * i)], {.multipath_order = 2 + i % 2});
    });
    return pings;
  };
  const std::vector<Ping> one = pings_with(1);
  double energy = 0.0;
  for (const Ping& ping : one) energy += sum_of(ping.echo.multipath);
  ASSERT_GT(energy, 0.0);
  for (const int threads : {1, 2, 8}) {
    const std::vector<Ping> other = pings_with(threads);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_TRUE(same_bits(one[i].echo.multipath, other[i].echo.multipath)) << threads << " threads, ping " << i;
    }
  }
}

TEST(Multipath, OrderZeroIsNoLayerAndNoneChangesTheDirectEcho) {
  const Scene scene = load_scene("test_tank");
  const RayScene rays(scene);
  const PingTracer tracer(rays, load_sonar("oculus_m1200d_hf"), scene.water);
  const Ping none = tracer.trace(scene.waypoints[3]);
  EXPECT_TRUE(none.echo.multipath.empty());
  const Ping third = tracer.trace(scene.waypoints[3], {.multipath_order = 3});
  EXPECT_EQ(third.echo.multipath.rows(), third.echo.direct.rows());
  EXPECT_EQ(third.echo.multipath.columns(), third.echo.direct.columns());
  EXPECT_TRUE(same_bits(none.echo.direct, third.echo.direct));
}

// Machines without AVX2 get the same paths but for the last bits of their ranges, which move single paths to others.
TEST(Multipath, EveryInstructionSetFindsTheSameEnergy) {
  const Scene scene = load_scene("test_tank");
  const SonarModel sonar = load_sonar("oculus_m1200d_hf");
  const auto energy = [&](const char* isa) {
    const RayScene rays(scene, isa);
    const PingTracer tracer(rays, sonar, scene.water);
    double sum = 0.0;
    for (const std::size_t i : {std::size_t{3}, std::size_t{9}}) {
      sum += sum_of(tracer.trace(scene.waypoints.at(i), {.multipath_order = 3}).echo.multipath);
    }
    return sum;
  };
  const double wanted = energy("avx2");
  ASSERT_GT(wanted, 0.0);
  for (const char* isa : {"sse4.2", "sse2"}) EXPECT_NEAR(energy(isa), wanted, 0.01 * wanted) << isa;
}

// A lane that is not valid may hold anything; Embree's sets without packets of eight pass over the mask.
TEST(Multipath, LanesThatAreNotValidAreNotCast) {
  const Scene scene = scene_of({floor_mesh(-1.0)});
  const float nan = std::nanf("");
  for (const char* isa : {"avx2", "sse4.2", "sse2"}) {
    SCOPED_TRACE(isa);
    const RayScene rays(scene, isa);
    RayPacket packet;
    packet.origin.fill({nan, nan, nan});
    packet.direction.fill({nan, nan, nan});
    packet.reach_m.fill(10.0F);
    for (const int lane : {0, 5}) {
      packet.valid[lane] = true;
      packet.origin[lane] = {0.25F, 0.5F, 0.0F};
      packet.direction[lane] = {0.0F, 0.0F, -2.0F};
    }
    packet.direction[6] = packet.direction[5];  // would be blocked as well
    packet.origin[6] = packet.origin[5];
    const auto blocked = packet.occluded(rays);
    for (int lane = 0; lane < packet_lanes; ++lane) EXPECT_EQ(blocked[lane], packet.valid[lane]) << lane;

    for (Eigen::Vector3f& direction : packet.direction) direction *= 0.5F;
    const auto hits = packet.intersect(rays, true);
    for (int lane = 0; lane < packet_lanes; ++lane) {
      EXPECT_EQ(hits[lane].surface, packet.valid[lane] ? 0 : -1) << lane;
      if (packet.valid[lane]) {
        EXPECT_NEAR(hits[lane].distance_m, 1.0F, 1e-5F) << lane;
      }
    }
  }
}

// A plane sends nothing to itself.
TEST(Multipath, FlatFloorAloneHasNone) {
  const Scene scene = scene_of({floor_mesh(-1.0)});
  const RayScene rays(scene);
  const SonarModel sonar = bare_sonar({.elevation_fov_deg = 40.0});
  const Ping ping =
      PingTracer(rays, sonar, scene.water).trace(pose_from_xyz_rpy({0, 0, 0}, 0, 0.3, 0), {.multipath_order = 3});
  ASSERT_GT(sum_of(ping.echo.direct), 0.0);
  EXPECT_EQ(sum_of(ping.echo.multipath), 0.0);
}

TEST(Multipath, RefusesOrdersAndSamplesBeyondItsRule) {
  const Scene scene = scene_of({floor_mesh(-1.0)});
  const RayScene rays(scene);
  const MultipathTracer tracer(rays, bare_sonar({.elevation_fov_deg = 40.0}), scene.water);
  EXPECT_THROW(tracer.trace(Pose::Identity(), 1), ConfigError);
  EXPECT_THROW(tracer.trace(Pose::Identity(), 4), ConfigError);
  EXPECT_THROW(tracer.trace(Pose::Identity(), 2, 0.0), ConfigError);
  EXPECT_THROW(tracer.trace(Pose::Identity(), 2, std::nan("")), ConfigError);
}

// A wooden box between the mirror walls of the test tank, from three poses. The image sources of its visible surface in
// every wall say where its ghosts are, for both directions of travel. Without the walls a convex box has no multipath.
TEST(Multipath, GhostsOfABoxInTheTestTank) {
  const Scene tank = box_between_mirrors();
  Scene alone = tank;
  alone.instances.erase(alone.instances.begin(), alone.instances.begin() + 4);
  const RayScene rays(tank);
  const RayScene rays_alone(alone);
  const SonarModel sonar = load_sonar("oculus_m1200d_hf", {{}, 8.0, {}});

  const std::vector<Mirror> walls{
      {{3.5, 0, 0}, {-1, 0, 0}}, {{-3.5, 0, 0}, {1, 0, 0}}, {{0, 3.5, 0}, {0, -1, 0}}, {{0, -3.5, 0}, {0, 1, 0}}};
  std::vector<Vec3> surface;
  for (int i = 0; i <= 80; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const double a = i / 80.0;
      const double z = -2.2 + 0.9 * j / 60.0;
      surface.insert(
          surface.end(),
          {{1.2, 2.3 + 0.6 * a, z}, {1.8, 2.3 + 0.6 * a, z}, {1.2 + 0.6 * a, 2.3, z}, {1.2 + 0.6 * a, 2.9, z}});
    }
  }
  for (const Pose& pose : poses_at_box()) {
    std::vector<Ghost> ghosts;
    for (const Mirror& mirror : walls) {
      for (const Ghost& g : ghosts_of(rays, mirror, surface, sonar.geometry, pose)) {
        if (std::find(ghosts.begin(), ghosts.end(), g) == ghosts.end()) ghosts.push_back(g);
      }
    }
    const Image2<float> layer = MultipathTracer(rays, sonar, tank.water).trace(pose, 2);
    const Image2<float> without = MultipathTracer(rays_alone, sonar, tank.water).trace(pose, 2);
    EXPECT_EQ(sum_of(without), 0.0);
    // The corners of the tank are 60 dB brighter than what passes over wood.
    const float least = 1e-6f * *std::max_element(layer.pixels().begin(), layer.pixels().end());
    int lit = 0;
    for (const Ghost& g : ghosts) {
      float most = 0.0f;
      for (int bin = std::max(g.bin - 1, 0); bin <= std::min(g.bin + 1, layer.rows() - 1); ++bin) {
        for (int beam = std::max(g.beam - 1, 0); beam <= std::min(g.beam + 1, layer.columns() - 1); ++beam)
          most = std::max(most, layer(bin, beam));
      }
      lit += most > least ? 1 : 0;
    }
    ASSERT_GT(ghosts.size(), 100u);
    const auto all_lit =
        std::count_if(layer.pixels().begin(), layer.pixels().end(), [&](float x) { return x > least; });
    EXPECT_LT(static_cast<double>(all_lit), 0.5 * static_cast<double>(layer.size()));  // not by being everywhere
    EXPECT_GE(lit, 0.95 * static_cast<double>(ghosts.size()));
  }
}

}  // namespace
}  // namespace ensonify
