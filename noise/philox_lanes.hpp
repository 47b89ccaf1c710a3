#pragma once

#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "ensonify/core/random.hpp"

namespace ensonify {

/// Philox4x32-10 (Salmon et al. 2011) of eight counters at once, each word in the lower half of 64 bits: so products
/// need no shuffling, and all stays in registers over the ten rounds. The same words as `random_words`.
struct PhiloxLanes {
  using Four = std::uint64_t __attribute__((vector_size(32)));
  static constexpr int lanes = 8;
  Four c0[2]{}, c1[2]{}, c2[2]{}, c3[2]{};

  void run(RandomKey key) {
    std::uint32_t k0 = key.word0;
    std::uint32_t k1 = key.word1;
    for (int round = 0; round < 10; ++round) {
      for (int half = 0; half < 2; ++half) {
        const Four p0 = product(c0[half], 0xD2511F53u);
        const Four p1 = product(c2[half], 0xCD9E8D57u);
        c0[half] = (p1 >> 32) ^ c1[half] ^ std::uint64_t{k0};
        c2[half] = (p0 >> 32) ^ c3[half] ^ std::uint64_t{k1};
        c1[half] = p1 & std::uint64_t{0xffffffffu};
        c3[half] = p0 & std::uint64_t{0xffffffffu};
      }
      k0 += 0x9E3779B9u;
      k1 += 0xBB67AE85u;
    }
  }

 private:
  static Four product(Four a, std::uint32_t b) {
#ifdef __AVX2__
    // The compiler would multiply the upper halves too, not knowing that they are zero.
    return reinterpret_cast<Four>(_mm256_mul_epu32(reinterpret_cast<__m256i>(a), _mm256_set1_epi64x(b)));
#else
    return a * std::uint64_t{b};
#endif
  }
};

}  // namespace ensonify
