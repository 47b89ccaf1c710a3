#include "ensonify/generators/variety.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "ensonify/core/random.hpp"
#include "ensonify/generators/near_pairs.hpp"

namespace ensonify {
namespace {

constexpr int rows = 256, columns = 128;

/// Echoes at random places on nothing, as a clean image has them.
Image2<std::uint8_t> echoes(std::uint64_t seed, int count, int shift_beams = 0, double gain = 1) {
  RandomSequence random(RandomKey::from_seed(seed).child("echoes"));
  Image2<double> level(rows, columns);
  for (int e = 0; e < count; ++e) {
    const double r = random.uniform(0, rows), c = random.uniform(0, columns) + shift_beams;
    const double height = random.uniform(8, 30), width = random.uniform(4, 15), peak = random.uniform(40, 200);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        level(i, j) += peak * std::exp(-0.5 * (std::pow((i - r) / height, 2) + std::pow((j - c) / width, 2)));
      }
    }
  }
  Image2<std::uint8_t> image(rows, columns);
  for (std::size_t p = 0; p < image.size(); ++p) {
    image.pixels()[p] = static_cast<std::uint8_t>(std::min(255.0, gain * level.pixels()[p]));
  }
  return image;
}

int distance(const Image2<std::uint8_t>& a, const Image2<std::uint8_t>& b) {
  return std::popcount(perceptual_hash(thumbnail_of(a)) ^ perceptual_hash(thumbnail_of(b)));
}

TEST(Thumbnail, IsTheMeanOfTheLogarithm) {
  Image2<std::uint8_t> image(64, 96, 0);
  image(2, 3) = 255;  // one of the six pixels of cell (1, 1)
  const Thumbnail small = thumbnail_of(image);
  EXPECT_EQ(small[33], std::lround(255.0 / 6));
  EXPECT_EQ(std::count(small.begin(), small.end(), 0), 32 * 32 - 1);
  image = Image2<std::uint8_t>(64, 96, 15);
  EXPECT_EQ(thumbnail_of(image)[500], std::lround(255.0 * 4 / 8));
}

TEST(Thumbnail, TakesImagesSmallerThanItself) {
  EXPECT_EQ(thumbnail_of(Image2<std::uint8_t>(3, 5, 255))[1023], 255);
  EXPECT_EQ(thumbnail_of(Image2<std::uint8_t>())[0], 0);
}

TEST(PerceptualHash, IsBlindToGainAndSeesAShift) {
  constexpr int n = 40;
  double dimmed = 0, shifted = 0;
  for (int i = 0; i < n; ++i) {
    const auto image = echoes(static_cast<std::uint64_t>(i), 6);
    EXPECT_EQ(distance(image, echoes(static_cast<std::uint64_t>(i), 6)), 0);
    dimmed += distance(image, echoes(static_cast<std::uint64_t>(i), 6, 0, 0.8)) / double{n};
    shifted += distance(image, echoes(static_cast<std::uint64_t>(i), 6, 16)) / double{n};
  }
  EXPECT_LT(dimmed, near_hash_distance);
  EXPECT_GT(shifted, 2 * near_hash_distance);
}

// The frequencies of white noise are exchangeable, so two hashes are random 31 of 63 bits: their distance is
// 2 (31 - common), mean 31.49, sigma 4.0 (hypergeometric). n = 1000, alpha = 1e-6: 4.9 sigma / sqrt(n) = 0.62.
TEST(PerceptualHash, UnlikeImagesDifferInHalfOfTheBits) {
  constexpr int n = 1000;
  const RandomKey key = RandomKey::from_seed(9).child("noise");
  const auto noise = [&](int i) {
    Thumbnail t;
    for (std::size_t p = 0; p < t.size(); ++p) {
      t[p] = static_cast<std::uint8_t>(256 * uniform_at(key.child(static_cast<std::uint64_t>(i)), p));
    }
    return perceptual_hash(t);
  };
  double mean = 0;
  for (int i = 0; i < n; ++i) {
    const std::uint64_t hash = noise(2 * i);
    ASSERT_EQ(std::popcount(hash), 31);
    mean += std::popcount(hash ^ noise(2 * i + 1)) / double{n};
  }
  EXPECT_NEAR(mean, 31.49, 0.62);
}

TEST(PerceptualHash, BlankHasNone) {
  EXPECT_EQ(perceptual_hash(thumbnail_of(Image2<std::uint8_t>(rows, columns, 0))), 0u);
  EXPECT_EQ(perceptual_hash(thumbnail_of(Image2<std::uint8_t>(rows, columns, 200))), 0u);
}

TEST(Correlation, OfItselfItsNegativeAndBlank) {
  const Thumbnail t = thumbnail_of(echoes(1, 5));
  Thumbnail negative;
  std::transform(t.begin(), t.end(), negative.begin(),
                 [](std::uint8_t v) { return static_cast<std::uint8_t>(255 - v); });
  EXPECT_NEAR(correlation(t, t), 1, 1e-12);
  EXPECT_NEAR(correlation(t, negative), -1, 1e-12);
  EXPECT_EQ(correlation(t, Thumbnail{}), 0);
}

std::vector<HashPair> sorted(std::vector<HashPair> pairs) {
  std::sort(pairs.begin(), pairs.end(), [](auto& x, auto& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return pairs;
}

RC_GTEST_PROP(NearPairs, AreThoseOfEveryPairTried, ()) {
  const int most = *rc::gen::inRange(0, 16);
  const auto bases =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<std::uint64_t>>(rc::gen::arbitrary<std::uint64_t>()));
  std::vector<std::uint64_t> hashes;
  const int n = *rc::gen::inRange(0, 60);
  for (int i = 0; i < n; ++i) {  // near some base, so that there are pairs on either side of the limit
    std::uint64_t hash = bases[*rc::gen::inRange<std::size_t>(0, std::min<std::size_t>(bases.size(), 4))];
    for (int flip = *rc::gen::inRange(0, 12); flip > 0; --flip) hash ^= std::uint64_t{1} << *rc::gen::inRange(0, 64);
    hashes.push_back(hash);
  }
  std::vector<HashPair> expected, found;
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      const int d = std::popcount(hashes[static_cast<std::size_t>(a)] ^ hashes[static_cast<std::size_t>(b)]);
      if (d <= most) expected.push_back({a, b, d});
    }
  }
  visit_near_pairs(hashes, most, [&](const HashPair& pair) {
    found.push_back(pair);
    return true;
  });
  RC_ASSERT(sorted(found) == sorted(expected));
}

TEST(NearPairs, EndWhenToldTo) {
  const std::vector<std::uint64_t> same(1000, 42);
  int visits = 0;
  visit_near_pairs(same, 3, [&](const HashPair&) { return ++visits < 10; });
  EXPECT_EQ(visits, 10);
}

// A frame with one small echo is told by where it is: the same one dimmer is nearly equal, another place is not.
TEST(Variety, FindsTheSameEchoAndNotJustAsEmptyAFrame) {
  std::vector<Thumbnail> frames;
  for (std::uint64_t seed = 0; seed < 60; ++seed) frames.push_back(thumbnail_of(echoes(seed, 1)));
  frames.push_back(thumbnail_of(echoes(7, 1, 0, 0.95)));
  frames.push_back(Thumbnail{});
  frames.push_back(Thumbnail{});
  const Variety variety = find_near_pairs(frames, 5);
  EXPECT_EQ(variety.frames, 63);
  EXPECT_EQ(variety.blank, 2);
  EXPECT_EQ(variety.pairs, 1u);
  EXPECT_EQ(variety.frames_in_pairs, 2);
  EXPECT_TRUE(variety.complete);
  ASSERT_EQ(variety.closest.size(), 1u);
  EXPECT_EQ(variety.closest[0].a, 7);
  EXPECT_EQ(variety.closest[0].b, 60);
}

}  // namespace
}  // namespace ensonify
