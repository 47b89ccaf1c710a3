#pragma once

#include <span>
#include <vector>

#include "ensonify/generators/perceptual_hash.hpp"

namespace ensonify {

/// Two frames count as nearly equal where both hold; why these figures: docs/datasets.md, "How alike".
constexpr int near_hash_distance = 7;
constexpr double near_correlation = 0.99;

struct NearPair {
  int a = 0, b = 0;  ///< indices into what was compared, a < b
  int distance = 0;  ///< bits
  double correlation = 0;
};

struct Variety {
  int frames = 0;
  int blank = 0;  ///< of one grey level throughout: they are all alike, and in no pair
  std::uint64_t pairs = 0;
  int frames_in_pairs = 0;
  /// False where the search ended early, at 20 million pairs of like hash: then there are more pairs than told.
  bool complete = true;
  std::vector<NearPair> closest;  ///< highest correlation first
};

/// Nearly equal pairs among thumbnails: first by hash, then each confirmed by correlation, because the hash of an
/// image with few echoes has few bits to tell. `keep`: how many of the closest are listed.
Variety find_near_pairs(std::span<const Thumbnail> thumbnails, int keep);

}  // namespace ensonify
