#include "ensonify/generators/map_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/map_box.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "ensonify/mapping/map_conversion.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using test::box_frame;

/// Three noisy pings across a box that is larger than their reach; truth and observable cells without any order.
struct Example {
  OccupancyGrid grid{box_frame({-1, -3, -1.2}, {6.2, 3, 1.2}, 0.2), {}, {}};
  std::vector<PosedImage> pings;

  Example() {
    const RandomKey key = RandomKey::from_seed(9);
    for (std::size_t i = 0; i < grid.frame.cells(); ++i) {
      grid.occupancy.push_back(uniform_at(key, i) < 0.03 ? 1 : 0);
      grid.observable.push_back(uniform_at(key, i + 100'000) < 0.6);
    }
    for (int i = 0; i < 3; ++i) {
      Pose pose = Pose::Identity();
      pose.translation() = Vec3(0.4 * i, 0.3, 0.1);
      pings.push_back(test::noise_image(test::sonar(60, 20, 5), pose, static_cast<std::uint64_t>(i)));
    }
  }
};

void expect_same(const MapCounts& a, const MapCounts& b) {
  EXPECT_EQ(a.true_free, b.true_free);
  EXPECT_EQ(a.false_free, b.false_free);
  EXPECT_EQ(a.true_occupied, b.true_occupied);
  EXPECT_EQ(a.false_occupied, b.false_occupied);
  EXPECT_EQ(a.observable, b.observable);
  EXPECT_EQ(a.hidden_false_free, b.hidden_false_free);
  EXPECT_EQ(a.squared_error, b.squared_error);
  for (std::size_t i = 0; i < a.tolerant.size(); ++i) {
    EXPECT_EQ(a.tolerant[i].right, b.tolerant[i].right);
    EXPECT_EQ(a.tolerant[i].found, b.tolerant[i].found);
    EXPECT_EQ(a.tolerant[i].false_free, b.tolerant[i].false_free);
    EXPECT_EQ(a.tolerant[i].false_occupied, b.tolerant[i].false_occupied);
  }
}

TEST(MapCurve, SlabsGiveTheScoresOfTheWholeAndOfMapsMadeOneByOne) {
  const Example example;
  const MapTruth truth = map_truth(example.grid, {0, 2});
  const std::vector<double> thresholds{0, 5, 20, 60};
  for (const char* name : {"points", "arc", "carve", "oracle"}) {
    const InverseModel model = inverse_model_named(name);
    const ScoredMaps whole = score_maps(example.pings, model, thresholds, truth, example.grid.frame, 1e12);
    const ScoredMaps slabs = score_maps(example.pings, model, thresholds, truth, example.grid.frame, 1.4e6);
    for (std::size_t t = 0; t < thresholds.size(); ++t) {
      SCOPED_TRACE(testing::Message() << name << " at " << thresholds[t]);
      expect_same(slabs.counts[t], whole.counts[t]);
      for (const std::size_t side : {0u, 1u}) {
        EXPECT_TRUE(std::ranges::equal(slabs.seen[t][side].pixels(), whole.seen[t][side].pixels()));
      }
      LogOddsGrid map(example.grid.frame);
      for (const PosedImage& ping : example.pings) integrate_ping(ping, thresholds[t], model, map);
      expect_same(whole.counts[t], count_map(dense_map(map), truth));
    }
    EXPECT_EQ(whole.counts[0].fnr(), 1);
    EXPECT_EQ(whole.counts[0].fpr(), 0);
  }
}

TEST(MapCurve, PartsCoverTheBoxOnceWithTheirMargin) {
  const GridFrame box = box_frame({-1, -3, -1.2}, {6.2, 3, 1.2}, 0.2);
  const double layer = 100.0 * 32 * 16;  // bytes, of cells padded to blocks
  const std::vector<MapPart> parts = parts_of(box, 2, 100, 16 * layer);
  EXPECT_EQ(parts.size(), 3u);  // 12 of 36 layers each: 16 less the margins
  int covered = 0;
  for (const MapPart& part : parts) {
    EXPECT_LE(part.frame.size[0], 16);
    EXPECT_NEAR(part.frame.origin_m.x() + 0.2 * part.core.low[0], box.origin_m.x() + 0.2 * covered, 1e-9);
    covered += part.core.high[0] - part.core.low[0];
  }
  EXPECT_EQ(covered, box.size[0]);
  EXPECT_EQ(parts_of(box, 2, 100, 40 * layer).size(), 1u);
  EXPECT_THROW(parts_of(box, 2, 100, 7 * layer), ConfigError);
  EXPECT_THROW(parts_of(box, 4, 100, 8 * layer), ConfigError);
}

TEST(MapBox, CellsBeginAtMultiplesOfTheResolutionAndAGridGivesItselfAgain) {
  const MemoryRule plenty{10, 0, 1e12};
  for (const double resolution_m : {0.05, 0.1, 0.3}) {
    GridFrame grid{.origin_m = resolution_m * Vec3(-76, -31, -66), .resolution_m = resolution_m, .size = {152, 11, 66}};
    const GridFrame again = frame_over(box_of_grid(grid), resolution_m, plenty);
    EXPECT_EQ(again.size, grid.size);
    EXPECT_TRUE(again.origin_m.isApprox(grid.origin_m, 1e-12));
  }
  const GridFrame wider = frame_over({Vec3(-1.01, 0.02, -2), Vec3(0.99, 0.21, -1)}, 0.1, plenty);
  EXPECT_EQ(wider.size, (std::array<int, 3>{21, 3, 10}));
  EXPECT_NEAR(wider.origin_m.x(), -1.1, 1e-12);
}

TEST(MapBox, TooMuchMemoryIsRefusedWithAResolutionThatFits) {
  const WorldBox box{Vec3(0, 0, 0), Vec3(10, 10, 10)};
  const MemoryRule rule{9, 0, 9e6};
  std::string message;
  try {
    frame_over(box, 0.001, rule);
  } catch (const ConfigError& error) {
    message = error.what();
  }
  const auto at = message.find("--resolution ");
  ASSERT_NE(at, std::string::npos) << message;
  EXPECT_NO_THROW(frame_over(box, std::stod(message.substr(at + 13)), rule));
  EXPECT_THROW(frame_over(box, 1e-9, rule), ConfigError);
  EXPECT_THROW(frame_over(box, 1e-300, rule), ConfigError);
  EXPECT_THROW(frame_over(box, 1, MemoryRule{9, 1e7, 9e6}), ConfigError);
}

}  // namespace
}  // namespace ensonify
