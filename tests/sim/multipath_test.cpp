// The layer as part of a ping: its bits, its noise, and the ghosts of a box in the test tank.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/sim/ray_packet.hpp"
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

std::vector<double> blocks_of(const Image2<float>& layer) {
  std::vector<double> blocks;
  for (int row = 0; row + 16 <= layer.rows(); row += 16) {
    for (int column = 0; column + 16 <= layer.columns(); column += 16) {
      double sum = 0.0;
      for (int r = 0; r < 16; ++r) {
        for (int c = 0; c < 16; ++c) sum += static_cast<double>(layer(row + r, column + c));
      }
      blocks.push_back(sum);
    }
  }
  return blocks;
}

struct Errors {
  double total = 0;         ///< of the whole layer
  double share_within = 0;  ///< of its energy, that lies in blocks within 10 % of the reference
  double mean = 0;          ///< of the blocks' errors, weighted with energy
  double worst = 0;         ///< of the blocks that hold 90 %
};

/// One ping against 64 times as many pairs, in blocks of 16 bins x 16 beams.
Errors against_reference(const MultipathTracer& tracer, const Pose& pose, double samples = 1.0) {
  const std::vector<double> given = blocks_of(tracer.trace(pose, 2, samples));
  const std::vector<double> wanted = blocks_of(tracer.trace(pose, 2, 64.0));
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return wanted[a] > wanted[b]; });
  const double all = std::accumulate(wanted.begin(), wanted.end(), 0.0);
  Errors errors;
  errors.total = std::abs(std::accumulate(given.begin(), given.end(), 0.0) / all - 1.0);
  double held = 0.0;
  for (const std::size_t i : order) {
    const double error = std::abs(given[i] - wanted[i]);
    if (error <= 0.1 * wanted[i]) errors.share_within += wanted[i] / all;
    if (held < 0.9 * all) errors.worst = std::max(errors.worst, error / wanted[i]);
    errors.mean += error / all;
    held += wanted[i];
  }
  return errors;
}

struct NoiseCase {
  const char* place;
  std::vector<std::size_t> waypoints;
  double total, share_within, mean, worst;
};

// The walls of the tank are smooth: nine tenths of the energy lie in blocks that are all within 10 %. Piles with growth
// and the rocks of a breakwater scatter between facets smaller than a beam, which a ping samples by a few walks each:
// there the blocks that hold half or more of the energy are within 10 %.
TEST(Multipath, NoiseOfBlocksAgainst64TimesThePairs) {
  for (const NoiseCase& c : {NoiseCase{"test_tank", {3, 5, 9, 11}, 0.02, 0.95, 0.03, 0.10},
                             NoiseCase{"pier_harbor", {0, 1, 3, 5}, 0.05, 0.65, 0.18, 0.60},
                             NoiseCase{"breakwater", {0, 1, 2, 3}, 0.05, 0.50, 0.18, 1.50}}) {
    const Scene scene = load_scene(c.place);
    const SonarModel sonar = load_sonar("oculus_m1200d_hf");
    const RayScene rays(scene);
    const MultipathTracer tracer(rays, sonar, scene.water);
    for (const std::size_t waypoint : c.waypoints) {
      SCOPED_TRACE(testing::Message() << c.place << " waypoint " << waypoint);
      const Errors errors = against_reference(tracer, scene.waypoints.at(waypoint));
      RecordProperty(std::string(c.place) + "_" + std::to_string(waypoint), std::to_string(errors.share_within));
      EXPECT_LE(errors.total, c.total);
      EXPECT_GE(errors.share_within, c.share_within);
      EXPECT_LE(errors.mean, c.mean);
      EXPECT_LE(errors.worst, c.worst);
    }
  }
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

// Between rocks, where a ping's walks are few.
TEST(Multipath, MoreSamplesBringBlocksWithinTenPercent) {
  const Scene scene = load_scene("breakwater");
  const RayScene rays(scene);
  const MultipathTracer tracer(rays, load_sonar("oculus_m1200d_hf"), scene.water);
  const Errors usual = against_reference(tracer, scene.waypoints.at(2));
  const Errors more = against_reference(tracer, scene.waypoints.at(2), 16.0);
  EXPECT_LE(more.mean, 0.5 * usual.mean);
  EXPECT_GE(more.share_within, 0.85);
}

// A wooden box between the mirror walls of the test tank, from three poses. The image sources of its visible surface in
// every wall say where its ghosts are, for both directions of travel. Without the walls a convex box has no multipath.
TEST(Multipath, GhostsOfABoxInTheTestTank) {
  Scene tank = load_scene("test_tank");
  std::erase_if(tank.instances, [](const Instance& i) { return i.name.rfind("wall_", 0) != 0; });
  ASSERT_EQ(tank.instances.size(), 4u);
  const auto glass =
      std::find_if(tank.materials.begin(), tank.materials.end(), [](const Material& m) { return m.name == "glass"; });
  Material wall{"mirror", -35.0, 14.6, 1100.0, "glass of the bundled table"};
  if (glass != tank.materials.end()) wall = *glass;
  tank.materials.push_back(wall);
  for (Instance& instance : tank.instances) instance.material = static_cast<int>(tank.materials.size()) - 1;
  tank.materials.push_back({"wood", -20.0, -12.8, 25.0, "bundled table"});
  tank.meshes.push_back(box_mesh({1.2F, 2.3F, -2.2F}, {1.8F, 2.9F, -1.3F}));
  Instance box;
  box.name = "box";
  box.mesh = static_cast<int>(tank.meshes.size()) - 1;
  box.material = static_cast<int>(tank.materials.size()) - 1;
  tank.instances.push_back(box);
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
  for (const Pose& pose :
       {pose_from_xyz_rpy({-1.5, 2.2, -1.7}, 0, 0.02, 0.35), pose_from_xyz_rpy({-2.0, 2.4, -1.75}, 0, 0, 0.3),
        pose_from_xyz_rpy({2.4, -1.0, -1.7}, 0, 0, 1.31)}) {
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
