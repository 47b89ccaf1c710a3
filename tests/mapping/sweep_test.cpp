#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "ensonify/mapping/threshold_sweep.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;

std::vector<double> zero_to_sixty() {
  std::vector<double> t(61);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i);
  return t;
}

std::vector<PosedImage> pings() {
  std::vector<PosedImage> all;
  for (int i = 0; i < 8; ++i) {
    const Pose pose = pose_from_xyz_rpy({0.1 * i, -0.2 * i, 0.05 * i}, 0.1 * i, 0.1 - 0.03 * i, 0.8 * i);
    all.push_back(noise_image(sonar(70, 20, 2.5, 80, 48), pose, static_cast<std::uint64_t>(i)));
  }
  return all;
}

GridFrame frame() { return box_frame({-2.487, -3.013, -1.031}, {3.013, 2.487, 1.269}, 0.1); }

TEST(ThresholdSweep, EqualToSixtyOneSeparateMaps) {
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    const InverseModel model = inverse_model_named(kind);
    ThresholdSweep sweep(frame(), zero_to_sixty(), model);
    for (const PosedImage& ping : pings()) sweep.add(ping);
    EXPECT_EQ(sweep.pings(), 8);
    EXPECT_LE(sweep.bytes(), ThresholdSweep::bytes_at_worst(frame(), 61, model));
    for (int k = 0; k < 61; ++k) {
      LogOddsGrid separate(frame());
      MarkBox<Mark> scratch;
      for (const PosedImage& ping : pings()) integrate_ping(ping, k, model, separate, scratch);
      ASSERT_TRUE(same(sweep.map_at(k), separate)) << kind << " at threshold " << k;
    }
  }
}

TEST(ThresholdSweep, FloatImagesAndUnevenThresholds) {
  PosedImage ping = pings()[0];
  Image2<float> level(80, 48);
  RandomSequence random(RandomKey::from_seed(1));
  for (float& z : level.pixels()) z = static_cast<float>(random.uniform(-3, 9));
  ping.grey = level;
  const std::vector<double> thresholds = {-1.5, 0, 0.25, 7.75};
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    ThresholdSweep sweep(frame(), thresholds, inverse_model_named(kind));
    sweep.add(ping);
    for (int k = 0; k < 4; ++k) {
      LogOddsGrid separate(frame());
      integrate_ping(ping, thresholds[static_cast<std::size_t>(k)], inverse_model_named(kind), separate);
      ASSERT_TRUE(same(sweep.map_at(k), separate)) << kind << k;
    }
  }
}

TEST(ThresholdSweep, PartsMakeTheWhole) {
  const GridFrame part = box_frame({-0.987, -3.013, -0.531}, {0.413, 0.687, 1.269}, 0.1);
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    ThresholdSweep whole(frame(), {20}, inverse_model_named(kind));
    ThresholdSweep some(part, {20}, inverse_model_named(kind));
    for (const PosedImage& ping : pings()) {
      whole.add(ping);
      some.add(ping);
    }
    const LogOddsGrid all = whole.map_at(0);
    const LogOddsGrid few = some.map_at(0);
    std::size_t different = 0;
    for_each_cell(part, [&](const Cell& c) { different += few.at(c) != all.at({c[0] + 15, c[1], c[2] + 5}); });
    EXPECT_LE(different, 3U) << kind << ": only centres on borders, to single precision";
  }
}

TEST(ThresholdSweep, SameFromOneTwoAndEightThreads) {
  std::vector<LogOddsGrid> maps;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    ThresholdSweep sweep(frame(), zero_to_sixty(), Oracle{});
    for (const PosedImage& ping : pings()) sweep.add(ping);
    maps.push_back(sweep.map_at(17));
  }
  EXPECT_TRUE(same(maps[0], maps[1]));
  EXPECT_TRUE(same(maps[0], maps[2]));
}

TEST(ThresholdSweep, MemoryIsAsStated) {
  const GridFrame big = {.origin_m = Vec3::Zero(), .resolution_m = 0.1, .size = {256, 256, 256}};
  const double cells = static_cast<double>(big.cells());
  EXPECT_NEAR(static_cast<double>(ThresholdSweep::bytes_at_worst(big, 61, Arc{})) / cells, 124 + 2, 2);
  EXPECT_NEAR(static_cast<double>(ThresholdSweep::bytes_at_worst(big, 61, Carve{})) / cells, 244 + 2, 3);
}

TEST(ThresholdSweep, ThresholdsThatMakeNoSenseAreRefused) {
  const auto refused = [](std::vector<double> t) { EXPECT_THROW(ThresholdSweep(frame(), t, Arc{}), ConfigError); };
  refused({});
  refused({3, 2});
  refused({3, 3});
  refused({std::nan("")});
  refused(std::vector<double>(255));
  ThresholdSweep sweep(frame(), {1, 2}, Arc{});
  EXPECT_THROW(sweep.map_at(2), ConfigError);
  EXPECT_THROW(sweep.map_at(-1), ConfigError);
}

}  // namespace
}  // namespace ensonify
