#include "ensonify/filters/activation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace ensonify {
namespace {

/// exp for |x| <= 87 by x = n ln 2 + r and the Taylor series of degree 6 in |r| <= ln 2 / 2 (rest below 2e-7):
/// the compiler makes vector code of it, as it can not of std::exp.
float short_exp(float x) {
  constexpr float ln2_high = 0.693359375F, ln2_low = -2.12194440e-4F;  // Cephes: n ln2_high is exact
  constexpr float round_to_whole = 12582912.0F;                        // 1.5 * 2^23: sums have no fraction
  const float n = (x * 1.44269504F + round_to_whole) - round_to_whole;
  const float r = (x - n * ln2_high) - n * ln2_low;
  const float series =
      1.0F + r * (1.0F + r * (1.0F / 2 + r * (1.0F / 6 + r * (1.0F / 24 + r * (1.0F / 120 + r * (1.0F / 720))))));
  return series * std::bit_cast<float>((static_cast<std::int32_t>(n) + 127) << 23);
}

void activate(Relu, std::span<float> numbers) {
  for (float& x : numbers) x = x > 0.0F ? x : 0.0F;
}
void activate(LeakyRelu leaky, std::span<float> numbers) {
  for (float& x : numbers) x = x > 0.0F ? x : leaky.slope * x;
}
void activate(Sigmoid, std::span<float> numbers) {
  for (float& x : numbers) {
    const float held = x > 87.0F ? 87.0F : x > -87.0F ? x : -87.0F;
    x = 1.0F / (1.0F + short_exp(-held));
  }
}

}  // namespace

void activate(const std::vector<Activation>& activations, std::span<float> numbers) {
  for (const Activation& activation : activations) {
    std::visit([&](auto kind) { activate(kind, numbers); }, activation);
  }
}

}  // namespace ensonify
