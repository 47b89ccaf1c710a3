#include "ensonify/generators/near_pairs.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "ensonify/core/error.hpp"

namespace ensonify {

void visit_near_pairs(std::span<const std::uint64_t> hashes, int most,
                      const std::function<bool(const HashPair&)>& visit) {
  if (most < 0 || most > 15) throw ConfigError("near pairs: the distance must be 0 to 15 bits");
  const int bands = most + 1;
  const auto mask_of = [&](int band) {
    const int first = 64 * band / bands, bits = 64 * (band + 1) / bands - first;
    return (bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1) << first;
  };
  std::vector<int> order(hashes.size());
  const auto hash_at = [&](std::size_t i) { return hashes[static_cast<std::size_t>(order[i])]; };
  for (int band = 0; band < bands; ++band) {
    const std::uint64_t mask = mask_of(band);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return (hashes[static_cast<std::size_t>(a)] & mask) < (hashes[static_cast<std::size_t>(b)] & mask);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && ((hash_at(i) ^ hash_at(j)) & mask) == 0; ++j) {
        const std::uint64_t differ = hash_at(i) ^ hash_at(j);
        const int distance = std::popcount(differ);
        if (distance > most) continue;
        // A pair that shares several bands is told by the first of them.
        bool told = false;
        for (int earlier = 0; earlier < band && !told; ++earlier) told = (differ & mask_of(earlier)) == 0;
        if (!told && !visit({order[i], order[j], distance})) return;
      }
    }
  }
}

}  // namespace ensonify
