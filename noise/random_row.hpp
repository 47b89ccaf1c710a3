#pragma once

#include <cstdint>
#include <span>

#include "ensonify/core/random.hpp"

namespace ensonify {

/// Fills a row with numbers addressed by (key, row, position): position p holds word p % 4 of random_words(key, p / 4,
/// row). The same bits as one call a pixel, made eight blocks at a time.
void fill_words(RandomKey key, std::uint32_t row, std::span<std::uint32_t> words);

/// The same for any counters of 128 bits: four words of each, word w of counter i in words[w][i]. All spans are equally
/// long.
struct Counters {
  std::span<const std::uint32_t> c0, c1, c2, c3;
};
void words_at(RandomKey key, const Counters& counters, std::span<std::uint32_t> word0, std::span<std::uint32_t> word1);

/// Uniform in (0, 1), 23 bits: with one more the last number would round to 1.
inline float uniform_of(std::uint32_t word) { return (static_cast<float>(word >> 9) + 0.5f) * 0x1p-23f; }

/// Standard normal by inversion: erfinv of M. Giles (2010, single precision), relative error about 1e-6.
float normal_of(float uniform);
/// Rayleigh of scale 1 by inversion.
float rayleigh_of(float uniform);

/// Uniforms of one row: fill_words as numbers.
void uniform_row(RandomKey key, std::uint32_t row, std::span<float> uniforms);

/// The same for whole rows, in place.
void to_normal(std::span<float> uniforms);
void to_rayleigh(std::span<float> uniforms);

}  // namespace ensonify
