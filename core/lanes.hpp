#pragma once

#include <cmath>
#include <cstring>

#ifdef __FMA__
#include <immintrin.h>
#endif

namespace ensonify {

inline constexpr int lane_count = 8;

/// Eight floats side by side, for loops that the compiler does not turn into vector code.
using Lanes = float __attribute__((vector_size(lane_count * sizeof(float))));

inline Lanes lanes_of(const float* values) {
  Lanes out;
  std::memcpy(&out, values, sizeof(out));
  return out;
}

inline void store(Lanes values, float* to) { std::memcpy(to, &values, sizeof(values)); }

/// a b + c, rounded once on any processor.
inline Lanes fused(Lanes a, Lanes b, Lanes c) {
#ifdef __FMA__
  return reinterpret_cast<Lanes>(
      _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
#else
  for (int l = 0; l < lane_count; ++l) c[l] = std::fma(a[l], b[l], c[l]);
  return c;
#endif
}

}  // namespace ensonify
