#pragma once

#include <cstdint>
#include <span>

#include "ensonify/core/random.hpp"

namespace ensonify {

/// Words 0 and 1 of random_words at any counters. All spans are equally long.
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

/// Uniforms addressed by (key, row, position): position p is uniform_of(word p % 4 of random_words(key, p / 4, row)).
void uniform_row(RandomKey key, std::uint32_t row, std::span<float> uniforms);

/// Both for whole rows, in place.
void to_normal(std::span<float> uniforms);
void to_rayleigh(std::span<float> uniforms);

}  // namespace ensonify
