#include "ensonify/core/random.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

using Philox = r123::Philox4x32;

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

/// Quantile of the standard normal, relative error below 1.2e-9 (P. J. Acklam 2003).
double acklam_quantile(double p) {
  constexpr std::array a{-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                         1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array b{-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02, 6.680131188771972e+01,
                         -1.328068155288572e+01};
  constexpr std::array c{-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                         -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array d{7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00, 3.754408661907416e+00};
  const auto tail = [&](double q) {
    return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
           ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1.0);
  };
  constexpr double p_low = 0.02425;
  if (p < p_low) return tail(std::sqrt(-2.0 * std::log(p)));
  if (p > 1.0 - p_low) return -tail(std::sqrt(-2.0 * std::log(1.0 - p)));
  const double q = p - 0.5;
  const double r = q * q;
  return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
         (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1.0);
}

}  // namespace

RandomKey RandomKey::from_seed(std::uint64_t seed) {
  return RandomKey{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}.child("ensonify");
}

RandomKey RandomKey::child(std::uint64_t tag) const {
  constexpr std::uint32_t derivation = 0x6b657921u;  // keeps derived keys apart from drawn numbers
  const auto words =
      Philox{}({{static_cast<std::uint32_t>(tag), static_cast<std::uint32_t>(tag >> 32), derivation, derivation}},
               {{word0, word1}});
  return {words[0], words[1]};
}

RandomKey RandomKey::child(std::string_view tag) const { return child(fnv1a(tag)); }

std::array<std::uint32_t, 4> random_words(RandomKey key, std::uint32_t c0, std::uint32_t c1, std::uint32_t c2) {
  const auto words = Philox{}({{c0, c1, c2, 0u}}, {{key.word0, key.word1}});
  return {words[0], words[1], words[2], words[3]};
}

double uniform_at(RandomKey key, std::uint64_t index) {
  const auto words = random_words(key, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), 1u);
  const std::uint64_t bits = (static_cast<std::uint64_t>(words[0]) << 32 | words[1]) >> 12;
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

double normal_at(RandomKey key, std::uint64_t index) {
  const double p = uniform_at(key, index);
  const double x = acklam_quantile(p);
  const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - p;
  const double u = error * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
  return x - u / (1.0 + 0.5 * x * u);
}

int RandomSequence::below(int n) { return std::min(static_cast<int>(uniform() * n), n - 1); }

}  // namespace ensonify
