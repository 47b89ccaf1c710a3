#include "ensonify/generators/attitude_noise.hpp"

#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

constexpr int waves = 16;

/// Of rms 1. The phase counts whole turns, so that it is exact at any time.
double rock(RandomKey key, double period_s, double time_s) {
  double sum = 0;
  for (int w = 0; w < waves; ++w) {
    const auto index = static_cast<std::uint64_t>(2 * w);
    const double frequency_hz = (0.5 + (w + uniform_at(key, index)) / waves) / period_s;
    const double turns = frequency_hz * time_s + uniform_at(key, index + 1);
    sum += std::cos(2.0 * std::numbers::pi * (turns - std::floor(turns)));
  }
  return std::sqrt(2.0 / waves) * sum;
}

}  // namespace

Vec3 rocking_rad(const AttitudeNoise& noise, RandomKey key, double time_s) {
  const auto axis = [&](const char* name, double rms_deg) {
    return rms_deg > 0.0 ? radians(rms_deg) * rock(key.child(name), noise.period_s, time_s) : 0.0;
  };
  return {axis("roll", noise.roll_deg), axis("pitch", noise.pitch_deg), axis("yaw", noise.yaw_deg)};
}

}  // namespace ensonify
