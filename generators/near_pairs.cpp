#include "ensonify/generators/near_pairs.hpp"

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

struct Entry {
  std::uint64_t hash = 0;
  int index = 0;
};

}  // namespace

void visit_near_pairs(std::span<const std::uint64_t> hashes, int most,
                      const std::function<bool(const HashPair&)>& visit) {
  if (most < 0 || most > 15) throw ConfigError("near pairs: the distance must be 0 to 15 bits");
  const int bands = most + 1;
  const auto mask_of = [&](int band) {
    const int first = 64 * band / bands, bits = 64 * (band + 1) / bands - first;
    return (bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1) << first;
  };
  std::vector<Entry> entries(hashes.size());
  for (int band = 0; band < bands; ++band) {
    const std::uint64_t mask = mask_of(band);
    for (std::size_t i = 0; i < hashes.size(); ++i) entries[i] = {hashes[i], static_cast<int>(i)};
    std::sort(entries.begin(), entries.end(), [mask](const Entry& x, const Entry& y) {
      return std::pair(x.hash & mask, x.index) < std::pair(y.hash & mask, y.index);
    });
    for (std::size_t i = 0; i < entries.size(); ++i) {
      for (std::size_t j = i + 1; j < entries.size(); ++j) {
        const std::uint64_t differ = entries[i].hash ^ entries[j].hash;
        if ((differ & mask) != 0) break;
        const int distance = std::popcount(differ);
        if (distance > most) continue;
        // A pair that shares several bands is told by the first of them.
        bool told = false;
        for (int earlier = 0; earlier < band && !told; ++earlier) told = (differ & mask_of(earlier)) == 0;
        if (!told && !visit({entries[i].index, entries[j].index, distance})) return;
      }
    }
  }
}

}  // namespace ensonify
