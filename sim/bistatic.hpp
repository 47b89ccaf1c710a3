#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "ensonify/scenes/material.hpp"

namespace ensonify {

/// A material as the inner loops of multipath use it.
///
/// Bistatic scattering of unit area, for directions i (where the sound comes from) and o (where it goes), both on the
/// side of the normal n, with the half vector h = (i + o) / |i + o|:
///   sigma(i, o) = mu cos(i) cos(o) + s cos^N(n, h) G(i, o)
///   G(i, o)     = min(1, 2 (n.h) (n.i) / (i.h), 2 (n.h) (n.o) / (i.h))
/// The first term is Lambert's law; the second the high-frequency Kirchhoff (geometric optics) law of facets of rms
/// slope 1 / sqrt(N), with the masking of V-shaped grooves (Torrance and Sparrow 1967). Facets so masked send out no
/// more than arrives (Heitz 2014, eq. 26), which bounds the albedo: integral of sigma over o / cos(i) <= pi mu + 8 pi s
/// / (N + 2). Reciprocal. With i = o it is `backscatter(material, cos_incidence)`, but for G, which there is 1 up to 45
/// degrees; the direct echo keeps the law without G.
struct SurfaceLaw {
  float mu = 0;
  float specular = 0;    ///< s
  float exponent = 2;    ///< N
  float lobe_share = 0;  ///< of the directions sampled, those from the lobe
};

namespace bistatic {

/// log2 of a positive number, to 3e-7 of (x - 1) near 1, where the lobe lives.
inline float log2_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;  // so that the mantissa is within sqrt(1/2) .. sqrt(2)
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  const float t = (m - 1.0f) / (m + 1.0f);
  const float t2 = t * t;
  const float series = 1.0f + t2 * (1.0f / 3.0f + t2 * (1.0f / 5.0f + t2 * (1.0f / 7.0f + t2 * (1.0f / 9.0f))));
  return static_cast<float>(exponent) + 2.88539008f * t * series;
}

/// 2^x, to 2e-7; 2^-126 for what is less.
inline float exp2_of(float x) {
  x = x > -126.0f ? x : -126.0f;
  constexpr float rounder = 12582912.0f;  // 1.5 * 2^23: adding it rounds to a whole number
  const float shifted = x + rounder;
  const float f = (x - (shifted - rounder)) * 0.693147181f;
  const float p =
      1.0f + f * (1.0f + f * (0.5f + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
  return p * std::bit_cast<float>((std::bit_cast<std::int32_t>(shifted) - 0x4b400000 + 127) << 23);
}

/// Scattering and the density (1/sr) with which `sample_lobe` and a cosine-weighted choice together pick `o` given `i`.
struct Scattered {
  float sigma;
  float pdf;
};

/// cos_i = n.i, cos_o = n.o, both positive; cos_io = i.o.
inline Scattered scatter(const SurfaceLaw& law, float cos_i, float cos_o, float cos_io) {
  constexpr auto inverse_pi = static_cast<float>(std::numbers::inv_pi);
  const float sum = 1.0f + cos_io > 1e-6f ? 1.0f + cos_io : 1e-6f;
  const float inverse_norm = 1.0f / std::sqrt(2.0f * sum);  // 1 / |i + o|; i.h = 1 / (2 inverse_norm)
  const float along = (cos_i + cos_o) * inverse_norm;
  const float cos_h = along < 1.0f ? along : 1.0f;
  const float lobe = exp2_of(law.exponent * log2_of(cos_h > 1e-9f ? cos_h : 1e-9f));
  const float least = cos_i < cos_o ? cos_i : cos_o;
  const float open = 4.0f * cos_h * least * inverse_norm;
  const float masking = open < 1.0f ? open : 1.0f;
  return {law.mu * cos_i * cos_o + law.specular * lobe * masking,
          law.lobe_share * (law.exponent + 1.0f) * 0.25f * inverse_pi * lobe * inverse_norm +
              (1.0f - law.lobe_share) * inverse_pi * cos_o};
}

}  // namespace bistatic

/// A material's law for multipath.
inline SurfaceLaw surface_law(const Material& material) {
  const double mu = std::pow(10.0, material.lambert_db / 10.0);
  const double s = std::pow(10.0, material.specular_db / 10.0);
  const double lambert_albedo = std::numbers::pi * mu;
  const double lobe_albedo = 8.0 * std::numbers::pi * s / (material.specular_exponent + 2.0);
  // Some of either kind, so that no direction that scatters is picked too rarely.
  const double share = lobe_albedo / (lambert_albedo + lobe_albedo + 1e-30);
  return {static_cast<float>(mu), static_cast<float>(s), static_cast<float>(material.specular_exponent),
          static_cast<float>(0.8 * share)};
}

}  // namespace ensonify
