#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ensonify {

struct HashPair {
  int a = 0, b = 0;  ///< indices, a < b
  int distance = 0;  ///< bits in which the hashes differ
  bool operator==(const HashPair&) const = default;
};

/// Calls visit for every pair of hashes that differ in at most `most` bits, once each, as long as it returns true.
/// Equal in one of most + 1 bands of bits (pigeonhole), so it looks only at hashes that share a band: for n hashes
/// spread evenly (most + 1) n^2 / 2^(64 / (most + 1)) comparisons. The order of the visits is fixed. Throws ConfigError
/// where `most` is not in 0..15.
void visit_near_pairs(std::span<const std::uint64_t> hashes, int most,
                      const std::function<bool(const HashPair&)>& visit);

}  // namespace ensonify
