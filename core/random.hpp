#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ensonify {

/// Address of a family of random numbers. Randomness is looked up, never consumed: the number at (key, counter) is the
/// same for any thread, order or neighbour (Philox4x32-10, Salmon et al. 2011, through Random123).
struct RandomKey {
  std::uint32_t word0 = 0;
  std::uint32_t word1 = 0;

  static RandomKey from_seed(std::uint64_t seed);
  /// An independent family: key.child("noise").child(frame).
  RandomKey child(std::uint64_t tag) const;
  RandomKey child(std::string_view tag) const;

  bool operator==(const RandomKey&) const = default;
};

/// Four words at a counter.
std::array<std::uint32_t, 4> random_words(RandomKey key, std::uint32_t c0, std::uint32_t c1 = 0, std::uint32_t c2 = 0);

/// Uniform in the open interval (0, 1) with 52 bits, at counter `index`.
double uniform_at(RandomKey key, std::uint64_t index);
/// Standard normal at counter `index`, by inversion (Acklam 2003 refined by one Halley step).
double normal_at(RandomKey key, std::uint64_t index);

/// Walks the counters of one key: for sampling a handful of parameters in order.
class RandomSequence {
 public:
  explicit RandomSequence(RandomKey key) : key_(key) {}
  double uniform() { return uniform_at(key_, next_++); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal() { return normal_at(key_, next_++); }
  /// Integer in [0, n).
  int below(int n);

 private:
  RandomKey key_;
  std::uint64_t next_ = 0;
};

}  // namespace ensonify
