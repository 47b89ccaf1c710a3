#include "ensonify/generators/variety.hpp"

#include <algorithm>
#include <tuple>

#include "ensonify/core/parallel.hpp"
#include "ensonify/generators/near_pairs.hpp"

namespace ensonify {
namespace {

constexpr std::uint64_t most_candidates = 20'000'000;

bool closer(const NearPair& x, const NearPair& y) {
  return std::tuple(-x.correlation, x.distance, x.a, x.b) < std::tuple(-y.correlation, y.distance, y.a, y.b);
}

void keep_closest(std::vector<NearPair>& pairs, std::size_t keep) {
  std::sort(pairs.begin(), pairs.end(), closer);
  if (pairs.size() > keep) pairs.resize(keep);
}

}  // namespace

Variety find_near_pairs(std::span<const Thumbnail> thumbnails, int keep) {
  Variety variety;
  variety.frames = static_cast<int>(thumbnails.size());
  std::vector<std::uint64_t> hash_of(thumbnails.size());
  parallel_for(variety.frames, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    hash_of[at] = perceptual_hash(thumbnails[at]);
  });
  std::vector<int> frame;
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < variety.frames; ++i) {
    if (hash_of[static_cast<std::size_t>(i)] == 0) continue;
    frame.push_back(i);
    hashes.push_back(hash_of[static_cast<std::size_t>(i)]);
  }
  variety.blank = variety.frames - static_cast<int>(frame.size());

  const auto kept = static_cast<std::size_t>(keep);
  std::vector<bool> in_pair(thumbnails.size());
  std::uint64_t candidates = 0;
  visit_near_pairs(hashes, near_hash_distance, [&](const HashPair& pair) {
    if (++candidates > most_candidates) {
      variety.complete = false;
      return false;
    }
    const int a = frame[static_cast<std::size_t>(pair.a)], b = frame[static_cast<std::size_t>(pair.b)];
    const double r = correlation(thumbnails[static_cast<std::size_t>(a)], thumbnails[static_cast<std::size_t>(b)]);
    if (r <= near_correlation) return true;
    ++variety.pairs;
    in_pair[static_cast<std::size_t>(a)] = in_pair[static_cast<std::size_t>(b)] = true;
    variety.closest.push_back({a, b, pair.distance, r});
    if (variety.closest.size() > kept + 4096) keep_closest(variety.closest, kept);
    return true;
  });
  keep_closest(variety.closest, kept);
  variety.frames_in_pairs = static_cast<int>(std::count(in_pair.begin(), in_pair.end(), true));
  return variety;
}

}  // namespace ensonify
