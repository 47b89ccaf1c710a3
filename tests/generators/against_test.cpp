#include "ensonify/generators/against.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/acceptance_bands.hpp"
#include "ensonify/generators/against_json.hpp"
#include "ensonify/output/atomic_file.hpp"
#include "ensonify/output/png.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Rayleigh's amplitude to the power 0.5 around a level, every pixel by itself.
Image2<std::uint8_t> speckle(int rows, int columns, double level, std::uint64_t seed) {
  const RandomKey key = RandomKey::from_seed(seed);
  Image2<std::uint8_t> image(rows, columns);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double amplitude = std::sqrt(-std::log(uniform_at(key, i)));
    image.pixels()[i] = static_cast<std::uint8_t>(std::min(255.0, level * std::sqrt(amplitude)));
  }
  return image;
}

GreyImage levels_of(const Image2<std::uint8_t>& image) {
  GreyImage result{Image2<float>(image.rows(), image.columns()), GreyDepth::bits8};
  std::copy(image.pixels().begin(), image.pixels().end(), result.grey.pixels().begin());
  return result;
}

TEST(EvenTiles, AreThoseOfEvenEcho) {
  // 4 x 4 tiles: speckle at level 60, but darkness in the first row, a ramp in the second, an edge in tile (2, 1).
  Image2<std::uint8_t> image = speckle(256, 128, 60, 1);
  for (int c = 0; c < 128; ++c) {
    for (int r = 0; r < 64; ++r) image(r, c) = static_cast<std::uint8_t>(image(r, c) / 6);
    for (int r = 64; r < 128; ++r) image(r, c) = static_cast<std::uint8_t>(image(r, c) * (0.3 + (r - 64) / 64.0));
  }
  for (int r = 160; r < 192; ++r) {
    for (int c = 32; c < 64; ++c) image(r, c) = 5;
  }
  const std::vector<Tile> all = all_tiles(levels_of(image)), even = even_tiles(all, default_least_level);
  EXPECT_EQ(all.size(), 16U);
  ASSERT_EQ(even.size(), 7U);
  for (const Tile& tile : even) {
    EXPECT_GE(tile.region.row0, 128);
    EXPECT_FALSE(tile.region.row0 == 128 && tile.region.column0 == 32);
    EXPECT_LT(tile.variation, 0.05);
    EXPECT_NEAR(tile.mean_level, 60 * std::tgamma(1.25), 2);
  }
  EXPECT_EQ(even_tiles(all, 5).size(), 11U);
}

TEST(EvenTiles, AreTheLeastVaryingOfMany) {
  const std::vector<Tile> all = all_tiles(levels_of(speckle(64 * 6 + 63, 32 * 6 + 31, 60, 2)));
  ASSERT_EQ(all.size(), 36U);
  const std::vector<Tile> even = even_tiles(all, default_least_level);
  ASSERT_EQ(even.size(), static_cast<std::size_t>(most_even_tiles));
  double most = 0;
  for (const Tile& tile : even) most = std::max(most, tile.variation);
  const auto smaller = [&](const Tile& t) { return t.variation <= most; };
  EXPECT_EQ(std::count_if(all.begin(), all.end(), smaller), most_even_tiles);
}

TEST(SpreadPairs, AreNeighboursFromAllOver) {
  EXPECT_EQ(spread_pairs(3, 64), (std::vector{0, 1, 2}));
  EXPECT_EQ(spread_pairs(100, 6), (std::vector{0, 1, 33, 34, 66, 67}));
  EXPECT_EQ(spread_pairs(5, 4), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(spread_pairs(9, 1), (std::vector{0}));
}

/// A folder of images, made anew.
class Against : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("ensonify_against_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  void add(const std::string& name, const Image2<std::uint8_t>& image) { write_file(folder / name, encode_png(image)); }
  SideFigures figures(const AgainstOptions& options = {}) {
    return describe_side(open_pings(folder, "test"), options, [](int, int) {});
  }
  std::string refusal_of_bands(const std::string& text) {
    write_file(folder / "acceptance.json", text);
    try {
      read_acceptance_bands(folder);
    } catch (const DataError& e) {
      return e.what();
    }
    return {};
  }
};

TEST_F(Against, FrozenSpeckleCorrelatesAndNoiseDoesNot) {
  // Rows 128 and on: the same bright speckle in every ping; above it dark noise, another one in each.
  for (int ping = 0; ping < 3; ++ping) {
    Image2<std::uint8_t> image = speckle(256, 128, 90, 7);
    const Image2<std::uint8_t> noise = speckle(128, 128, 25, 100 + static_cast<std::uint64_t>(ping));
    std::copy(noise.pixels().begin(), noise.pixels().end(), image.pixels().begin());
    add("ping" + std::to_string(ping) + ".png", image);
  }
  const SideFigures side = figures({64, default_least_level, {{"half", {128, 256, 0, 128}}}});
  EXPECT_EQ(side.ping_to_ping.pairs, 2);
  EXPECT_EQ(side.ping_to_ping.tiles.size(), 24U);  // the first row of tiles is left out
  EXPECT_FALSE(side.ping_to_ping.still.has_value());
  EXPECT_GT(side.ping_to_ping.bright.value(), 0.99);
  EXPECT_NEAR(side.ping_to_ping.dark.value(), 0, 0.05);
  ASSERT_EQ(side.regions.size(), 1U);
  EXPECT_GT(side.regions[0].ping_to_ping.value(), 0.99);
  EXPECT_NEAR(side.regions[0].speckle.fits.weibull_shape, 4, 0.15);
  ASSERT_EQ(side.tiles.size(), 48U);
  EXPECT_NEAR(side.even->fits.weibull_shape, 4, 0.15);
  EXPECT_NEAR(side.even->beam[1], 0, 0.03);

  const AcceptanceBand high{"interping_corr_high_snr", "", 0.9, {}}, shape{"weibull_shape", "", 3.6, 4.3},
      zero{"zero_share", "", {}, 0.0, true}, open{noise_band, "", {}, {}};
  EXPECT_EQ(inside(high, side), true);
  EXPECT_EQ(inside(shape, side), true);
  EXPECT_EQ(inside(zero, side), false);  // 0 is not below 0
  EXPECT_EQ(inside(open, side), std::nullopt);
  SideFigures moving = side;
  moving.ping_to_ping.still = false;
  EXPECT_EQ(inside(high, moving), std::nullopt);
}

TEST_F(Against, ThreadsMakeNoDifference) {
  for (int ping = 0; ping < 9; ++ping) {
    add(std::to_string(ping) + ".png", speckle(128, 64, 60, static_cast<std::uint64_t>(ping)));
  }
  std::vector<std::string> texts;
  for (const std::size_t threads : {1, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    texts.push_back(against_json(figures(), figures(), {}));
  }
  EXPECT_EQ(texts[0], texts[1]);
}

TEST_F(Against, SixteenBitsSayTheSame) {
  const Image2<std::uint8_t> image = speckle(128, 64, 60, 3);
  add("a.png", image);
  const SideFigures eight = figures();
  Image2<std::uint16_t> deep(128, 64);
  std::transform(image.pixels().begin(), image.pixels().end(), deep.pixels().begin(),
                 [](std::uint8_t v) { return static_cast<std::uint16_t>(257 * v); });
  write_file(folder / "a.png", encode_png(deep));
  const SideFigures sixteen = figures();
  EXPECT_EQ(eight.levels.histogram, sixteen.levels.histogram);
  EXPECT_NEAR(eight.levels.mean(), sixteen.levels.mean(), 1e-5);
  EXPECT_NEAR(eight.even->fits.weibull_shape, sixteen.even->fits.weibull_shape, 0.02);
}

TEST_F(Against, OneImageHasNoPairsAndEmptyWaterNoTiles) {
  add("a.png", Image2<std::uint8_t>(128, 64, 0));
  const SideFigures side = figures();
  EXPECT_EQ(side.ping_to_ping.pairs, 0);
  EXPECT_FALSE(side.ping_to_ping.bright.has_value());
  EXPECT_FALSE(side.even.has_value());
  EXPECT_EQ(side.levels.zeros, 128U * 64U);
  EXPECT_FALSE(against_json(side, side, unbounded_bands()).empty());
}

TEST_F(Against, BrokenBandsAreNamed) {
  EXPECT_TRUE(read_acceptance_bands(folder).empty());
  EXPECT_EQ(refusal_of_bands(R"({"bands": [{"id": "zero_share", "min": null, "max": 0.01}]})"), "");
  EXPECT_THAT(refusal_of_bands("{"), HasSubstr("acceptance.json"));
  EXPECT_THAT(refusal_of_bands("{}"), HasSubstr("broken bands"));
  EXPECT_THAT(refusal_of_bands("[1]"), HasSubstr("broken bands"));
  EXPECT_THAT(refusal_of_bands(R"({"bands": [{"id": 3}]})"), HasSubstr("broken bands"));
  EXPECT_THAT(refusal_of_bands(R"({"bands": [{"id": "zero", "max": 1}]})"), HasSubstr("no figure is called 'zero'"));
  EXPECT_THAT(refusal_of_bands(R"({"bands": [{"id": "zero_share", "min": 2, "max": 1}]})"), HasSubstr("above max"));
}

}  // namespace
}  // namespace ensonify
