#include "ensonify/sensor_models/receive_chain.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {
namespace {

template <typename Grey>
Image2<Grey> quantise_to(const Image2<float>& level, float full_scale) {
  Image2<Grey> grey(level.rows(), level.columns());
  const auto in = level.pixels();
  const auto out = grey.pixels();
  for (std::size_t i = 0; i < in.size(); ++i) {
    // The constant comes first: of two numbers that do not compare, std::max gives its first, and NaN becomes 0.
    out[i] = static_cast<Grey>(static_cast<int>(std::min(1.0f, std::max(0.0f, in[i])) * full_scale + 0.5f));
  }
  return grey;
}

/// (power)^(gamma / 2); the gammas of real devices (1 and 1/2) are square roots.
void apply_gamma(std::span<float> power, double gamma) {
  if (gamma == 1.0) {
    for (float& p : power) p = std::sqrt(p);
  } else if (gamma == 0.5) {
    for (float& p : power) p = std::sqrt(std::sqrt(p));
  } else {
    const float exponent = static_cast<float>(0.5 * gamma);
    for (float& p : power) p = p > 0.0f ? std::pow(p, exponent) : 0.0f;
  }
}

}  // namespace

double gain_db(const SonarModel& sonar, double range_m) {
  const ReceiveChain& chain = sonar.receive;
  return sonar.source_level_db + chain.tvg_spreading_db * std::log10(range_m) +
         2.0 * chain.tvg_absorption_db_per_m * range_m - chain.saturation_level_db;
}

std::vector<float> row_gains(const SonarModel& sonar) {
  std::vector<float> gain(static_cast<std::size_t>(sonar.geometry.range_bins));
  for (int bin = 0; bin < sonar.geometry.range_bins; ++bin) {
    gain[bin] = static_cast<float>(std::pow(10.0, gain_db(sonar, sonar.geometry.bin_centre_m(bin)) / 10.0));
  }
  return gain;
}

Image2<float> receive(const SonarModel& sonar, const Image2<float>& intensity) {
  Image2<float> level(intensity.rows(), intensity.columns());
  const std::vector<float> gains = row_gains(sonar);
  for (int bin = 0; bin < level.rows(); ++bin) {
    const auto in = intensity.row(bin);
    const auto out = level.row(bin);
    const float gain = gains[bin];
    for (std::size_t b = 0; b < out.size(); ++b) out[b] = std::min(1.0f, gain * in[b]);  // in this order NaN becomes 1
    apply_gamma(out, sonar.receive.gamma);
  }
  return level;
}

Image2<std::uint8_t> quantise(const Image2<float>& level) { return quantise_to<std::uint8_t>(level, 255.0f); }
Image2<std::uint16_t> quantise16(const Image2<float>& level) { return quantise_to<std::uint16_t>(level, 65535.0f); }

}  // namespace ensonify
