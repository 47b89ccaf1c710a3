#include "ensonify/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace ensonify {
namespace {

/// Philox4x32-10 from the paper (Salmon et al. 2011, section 3.3), apart from the library that the product uses.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::uint32_t k0, std::uint32_t k1) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(p0)};
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
  return c;
}

// Known answers of Random123 1.x (kat_vectors, philox4x32 10).
TEST(Random, KnownAnswers) {
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, 0, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({~0u, ~0u, ~0u, ~0u}, ~0u, ~0u), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0xa4093822, 0x299f31d0),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
  EXPECT_EQ(random_words({0, 0}, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const RandomKey key{i * 2654435761u, ~i};
    EXPECT_EQ(random_words(key, i, i * i, 7 * i), philox({i, i * i, 7 * i, 0}, key.word0, key.word1));
  }
}

// Pinned, worked out by the same algorithm in Python: a dataset must not change with compiler or machine.
TEST(Random, PinnedValues) {
  EXPECT_EQ(RandomKey::from_seed(0), (RandomKey{0x001e1ac0, 0x622458c5}));
  EXPECT_EQ(RandomKey::from_seed(42), (RandomKey{0xea024b5b, 0xef4ad74f}));
  EXPECT_EQ(RandomKey::from_seed(42).child("frame").child(7), (RandomKey{0xd1cacb09, 0x3d77de18}));
  EXPECT_EQ(uniform_at(RandomKey::from_seed(0), 0), 0.10023420490538004);
  EXPECT_EQ(uniform_at(RandomKey::from_seed(0), 1), 0.6451018655992097);
  EXPECT_EQ(uniform_at(RandomKey::from_seed(42), 2), 0.15327890441477876);
  EXPECT_NEAR(normal_at(RandomKey::from_seed(0), 0), -1.2802181914553097, 1e-14);
  EXPECT_NEAR(normal_at(RandomKey::from_seed(42), 1), 0.5749551457397305, 1e-14);
}

// n = 1e6, seed 1: mean 1/2 with standard error sqrt(1/12/n) = 2.9e-4, variance 1/12 with 7.5e-5; 4 sigma.
TEST(Random, UniformStaysInsideTheOpenInterval) {
  const RandomKey key = RandomKey::from_seed(1);
  double sum = 0;
  double squares = 0;
  constexpr int n = 1'000'000;
  for (int i = 0; i < n; ++i) {
    const double u = uniform_at(key, static_cast<std::uint64_t>(i));
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
  }
  EXPECT_NEAR(sum / n, 0.5, 4 * 2.9e-4);
  EXPECT_NEAR(squares / n, 1.0 / 12.0, 4 * 7.5e-5);
}

// Inversion: Phi(normal_at) must give back uniform_at, Phi(x) = erfc(-x / sqrt 2) / 2.
TEST(Random, NormalIsTheQuantile) {
  const RandomKey key = RandomKey::from_seed(3);
  double worst = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const double u = uniform_at(key, i);
    worst =
        std::max(worst, std::abs(0.5 * std::erfc(-normal_at(key, i) / std::numbers::sqrt2) - u) / std::min(u, 1 - u));
  }
  EXPECT_LT(worst, 1e-11);
}

// Children: no collisions among tags, order of tags matters, and no correlation between the numbers of two children
// (n = 1e5, |r| < 4 / sqrt n).
TEST(Random, ChildrenAreIndependent) {
  const RandomKey root = RandomKey::from_seed(9);
  std::set<std::pair<std::uint32_t, std::uint32_t>> keys;
  for (std::uint64_t tag = 0; tag < 10'000; ++tag) {
    const RandomKey child = root.child(tag);
    keys.emplace(child.word0, child.word1);
  }
  for (const char* tag : {"", "a", "b", "ab", "frame", "noise", "pose"}) {
    const RandomKey child = root.child(tag);
    keys.emplace(child.word0, child.word1);
  }
  EXPECT_EQ(keys.size(), 10'007u);
  EXPECT_NE(root.child("a").child("b"), root.child("b").child("a"));
  EXPECT_NE(root.child("a").child("b"), root.child("ab"));
  for (const auto& [a, b] : {std::pair{root.child(0), root.child(1)}, std::pair{root, root.child(0)},
                             std::pair{root.child("x"), RandomKey::from_seed(10).child("x")}}) {
    double product = 0;
    for (std::uint64_t i = 0; i < 100'000; ++i) product += normal_at(a, i) * normal_at(b, i);
    EXPECT_LT(std::abs(product / 1e5), 4.0 / std::sqrt(1e5));
  }
}

TEST(Random, SequenceWalksTheCountersAndBelowStaysBelow) {
  const RandomKey key = RandomKey::from_seed(5);
  RandomSequence sequence(key);
  EXPECT_EQ(sequence.uniform(), uniform_at(key, 0));
  EXPECT_EQ(sequence.normal(), normal_at(key, 1));
  std::array<int, 3> count{};
  for (int i = 0; i < 30'000; ++i) ++count.at(static_cast<std::size_t>(sequence.below(3)));
  for (const int c : count) EXPECT_NEAR(c, 10'000, 4 * 81.6);  // sqrt(n p q)
  EXPECT_EQ(sequence.below(1), 0);
}

}  // namespace
}  // namespace ensonify
