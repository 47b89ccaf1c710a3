#include "ensonify/noise/random_row.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "ensonify/noise/philox_lanes.hpp"

namespace ensonify {
namespace {

/// Natural logarithm for normal positive x, absolute error below 2e-7 |log x| + 1e-7 (polynomial of Cephes' logf).
/// Own, so that neither the compiler nor the C library decides the last bit, and without branches, so that rows
/// become vector code.
inline float log_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  // Mantissa in [sqrt(1/2), sqrt(2)).
  const std::uint32_t shifted = bits - 0x3f3504f3u;
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(shifted) >> 23);
  const float f = std::bit_cast<float>((shifted & 0x007fffffu) + 0x3f3504f3u) - 1.0f;
  const float z = f * f;
  float p = 7.0376836292e-2f;
  p = p * f - 1.1514610310e-1f;
  p = p * f + 1.1676998740e-1f;
  p = p * f - 1.2420140846e-1f;
  p = p * f + 1.4249322787e-1f;
  p = p * f - 1.6668057665e-1f;
  p = p * f + 2.0000714765e-1f;
  p = p * f - 2.4999993993e-1f;
  p = p * f + 3.3333331174e-1f;
  const float tail = f * z * p - 2.12194440e-4f * exponent - 0.5f * z;
  return f + tail + 0.693359375f * exponent;
}

/// -log((1 - x)(1 + x)) with x = 2u - 1, formed without cancellation near u = 0.
inline float depth_of(float u) { return -log_of(4.0f * u * (1.0f - u)); }
/// From this depth on a number is in the tails: one in 300.
constexpr float tail_depth = 5.0f;

/// erfinv(x) / x of w = depth_of(u), in the centre and in the tails.
inline float centre_of(float w) {
  const float a = w - 2.5f;
  float centre = 2.81022636e-08f;
  centre = 3.43273939e-07f + centre * a;
  centre = -3.5233877e-06f + centre * a;
  centre = -4.39150654e-06f + centre * a;
  centre = 0.00021858087f + centre * a;
  centre = -0.00125372503f + centre * a;
  centre = -0.00417768164f + centre * a;
  centre = 0.246640727f + centre * a;
  return 1.50140941f + centre * a;
}

inline float tail_of(float w) {
  const float b = std::sqrt(std::max(w, 0.0f)) - 3.0f;
  float tail = -0.000200214257f;
  tail = 0.000100950558f + tail * b;
  tail = 0.00134934322f + tail * b;
  tail = -0.00367342844f + tail * b;
  tail = 0.00573950773f + tail * b;
  tail = -0.0076224613f + tail * b;
  tail = 0.00943887047f + tail * b;
  tail = 1.00167406f + tail * b;
  return 2.83297682f + tail * b;
}

inline float normal_inline(float u, float factor) { return 1.41421356f * factor * (2.0f * u - 1.0f); }

/// In passes: each is a short chain of operations, so that the processor has several of them in work, and hardly any
/// chunk needs the tails.
inline void normals_of(float* __restrict u, std::size_t count, float* __restrict w) {
  int tails = 0;
  for (std::size_t i = 0; i < count; ++i) w[i] = depth_of(u[i]);
  for (std::size_t i = 0; i < count; ++i) tails += static_cast<int>(!(w[i] < tail_depth));
  if (tails == 0) {
    for (std::size_t i = 0; i < count; ++i) u[i] = normal_inline(u[i], centre_of(w[i]));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = normal_inline(u[i], w[i] < tail_depth ? centre_of(w[i]) : tail_of(w[i]));
    }
  }
}

inline float rayleigh_inline(float u) { return std::sqrt(std::max(-2.0f * log_of(u), 0.0f)); }

constexpr int lanes = PhiloxLanes::lanes;

/// The words of `lanes` consecutive values of the first counter, four of each in turn.
inline void philox_row(RandomKey key, std::uint32_t first, std::uint32_t row, std::uint32_t* out) {
  PhiloxLanes philox;
  for (std::uint32_t half = 0; half < 2; ++half) {
    const auto counter = [&](std::uint32_t l) { return std::uint64_t{first + 4 * half + l}; };
    philox.c0[half] = PhiloxLanes::Four{counter(0), counter(1), counter(2), counter(3)};
    philox.c1[half] = PhiloxLanes::Four{row, row, row, row};
  }
  philox.run(key);
  static_assert(std::endian::native == std::endian::little);
  for (int half = 0; half < 2; ++half) {
    const PhiloxLanes::Four low = philox.c0[half] | (philox.c1[half] << 32);
    const PhiloxLanes::Four high = philox.c2[half] | (philox.c3[half] << 32);
    for (int l = 0; l < 4; ++l) {
      const std::uint64_t words[2]{low[l], high[l]};
      std::memcpy(out + 4 * (4 * half + l), words, sizeof(words));
    }
  }
}

}  // namespace

void words_at(RandomKey key, const Counters& counters, std::span<std::uint32_t> word0, std::span<std::uint32_t> word1) {
  std::size_t first = 0;
  const auto look_up = [&](std::size_t count) {
    PhiloxLanes philox{};
    for (std::size_t l = 0; l < count; ++l) {
      philox.c0[l / 4][l % 4] = counters.c0[first + l];
      philox.c1[l / 4][l % 4] = counters.c1[first + l];
      philox.c2[l / 4][l % 4] = counters.c2[first + l];
      philox.c3[l / 4][l % 4] = counters.c3[first + l];
    }
    philox.run(key);
    for (std::size_t l = 0; l < count; ++l) {
      word0[first + l] = static_cast<std::uint32_t>(philox.c0[l / 4][l % 4]);
      word1[first + l] = static_cast<std::uint32_t>(philox.c1[l / 4][l % 4]);
    }
  };
  for (; first + lanes <= word0.size(); first += lanes) look_up(lanes);  // a number of lanes that the compiler knows
  if (first < word0.size()) look_up(word0.size() - first);
}

void uniform_row(RandomKey key, std::uint32_t row, std::span<float> uniforms) {
  std::array<std::uint32_t, 4 * lanes> words;
  std::uint32_t block = 0;
  for (std::size_t first = 0; first < uniforms.size(); first += words.size(), block += lanes) {
    const std::size_t count = std::min(words.size(), uniforms.size() - first);
    philox_row(key, block, row, words.data());
    for (std::size_t i = 0; i < count; ++i) uniforms[first + i] = uniform_of(words[i]);
  }
}

float normal_of(float uniform) {
  const float w = depth_of(uniform);
  return normal_inline(uniform, w < tail_depth ? centre_of(w) : tail_of(w));
}
float rayleigh_of(float uniform) { return rayleigh_inline(uniform); }

void to_normal(std::span<float> uniforms) {
  constexpr std::size_t chunk = 32;
  std::array<float, chunk> depths;
  std::size_t first = 0;
  for (; first + chunk <= uniforms.size(); first += chunk) normals_of(uniforms.data() + first, chunk, depths.data());
  normals_of(uniforms.data() + first, uniforms.size() - first, depths.data());
}

void to_rayleigh(std::span<float> uniforms) {
  for (float& u : uniforms) u = rayleigh_inline(u);
}

}  // namespace ensonify
