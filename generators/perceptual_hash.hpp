#pragma once

#include <array>
#include <cstdint>

#include "ensonify/core/image2.hpp"

namespace ensonify {

constexpr int thumbnail_side = 32;

/// A frame in small: mean of log(1 + grey) in 32 x 32 cells of equal share, 0..255. The logarithm makes a gain a shift
/// by a constant, which neither the hash nor the correlation sees. Rows = range, columns = beams.
using Thumbnail = std::array<std::uint8_t, thumbnail_side * thumbnail_side>;

Thumbnail thumbnail_of(const Image2<std::uint8_t>& image);

/// DCT hash, "pHash" (Zauner, Implementation and Benchmarking of Perceptual Image Hash Functions, 2010, section 3.2):
/// which of the 8 x 8 lowest frequencies lie above their median. Like images differ in few bits, unlike ones in about
/// half. Unlike Zauner's it holds the frequencies along range alone and along beams alone, since a flat bottom has no
/// others; the mean (bit 0) is always 0. An image without any contrast has no hash: 0.
std::uint64_t perceptual_hash(const Thumbnail& thumbnail);

/// Pearson correlation of two thumbnails, -1..1; 0 where either has no contrast.
double correlation(const Thumbnail& a, const Thumbnail& b);

}  // namespace ensonify
