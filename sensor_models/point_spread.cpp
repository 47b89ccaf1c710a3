#include "ensonify/sensor_models/point_spread.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/sensor_models/fan_border.hpp"

namespace ensonify {
namespace {

constexpr double nominal_sound_speed_mps = 1490.0;
constexpr double least_weight = 1e-4;  // -40 dB

/// Power that leaks from a bin into its k-th neighbour, averaged over the echo's place in its bin.
std::vector<float> pulse_weights(double bin_m, double bandwidth_hz) {
  const double full_width_bins = nominal_sound_speed_mps / (2.0 * bandwidth_hz) / bin_m;
  const double sigma = full_width_bins / 2.3548200450309493;  // FWHM = 2 sqrt(2 ln 2) sigma
  const auto normal_cdf = [&](double x) { return 0.5 * std::erfc(-x / (sigma * std::sqrt(2.0))); };
  constexpr int places = 64;
  std::vector<double> half;
  for (int k = 0; k <= 64; ++k) {
    double weight = 0.0;
    for (int i = 0; i < places; ++i) {
      const double place = (i + 0.5) / places;
      weight += (normal_cdf(k + 1.0 - place) - normal_cdf(k - place)) / places;
    }
    if (k > 0 && weight < least_weight) break;
    half.push_back(weight);
  }
  double sum = half[0];
  for (std::size_t k = 1; k < half.size(); ++k) sum += 2.0 * half[k];
  const int reach = static_cast<int>(half.size()) - 1;
  std::vector<float> weights;
  for (int k = -reach; k <= reach; ++k) {
    weights.push_back(static_cast<float>(half[static_cast<std::size_t>(std::abs(k))] / sum));
  }
  return weights;
}

Image2<float> band_matrix(const Aperture& aperture, const std::vector<double>& azimuth) {
  const int beams = static_cast<int>(azimuth.size());
  const double lobe = aperture.main_lobe_sine();
  const auto power_at = [&](double offset) {
    const double power = std::abs(offset) <= lobe ? aperture.power(offset) : 0.0;
    return power < least_weight ? 0.0 : power;
  };
  const auto weight = [&](int from, int to) {
    return static_cast<float>(power_at(std::sin(azimuth[from]) - std::sin(azimuth[to])));
  };
  int reach = 0;
  for (int b = 0; b < beams; ++b) {
    while (b + reach + 1 < beams && weight(b + reach + 1, b) > 0.0f) ++reach;
  }
  Image2<float> band(2 * reach + 1, beams);
  for (int d = 0; d < band.rows(); ++d) {
    for (int b = std::max(0, reach - d); b < std::min(beams, beams + reach - d); ++b) {
      band(d, b) = weight(b + d - reach, b);
    }
  }
  scale_beams(band, border_gain(azimuth, reach, power_at));
  return band;
}

}  // namespace

PointSpread::PointSpread(const SonarModel& sonar)
    : beam_weights_(band_matrix(sonar.receive_azimuth, sonar.geometry.beam_azimuth_rad)),
      range_weights_(pulse_weights(sonar.geometry.bin_size_m(), sonar.bandwidth_hz)) {}

Image2<float> PointSpread::apply(const Image2<float>& intensity) const {
  const int bins = intensity.rows();
  const int beams = intensity.columns();
  const int range_reach = static_cast<int>(range_weights_.size()) / 2;
  Image2<float> result(bins, beams);
  std::vector<float> padded(static_cast<std::size_t>(beams + 2 * reach()));
  for (int bin = 0; bin < bins; ++bin) {
    float* line = padded.data() + reach();
    std::fill_n(line, beams, 0.0f);
    for (int k = std::max(-range_reach, -bin); k <= std::min(range_reach, bins - 1 - bin); ++k) {
      const auto in = intensity.row(bin + k);
      const float weight = range_weights_[static_cast<std::size_t>(k + range_reach)];
      for (int b = 0; b < beams; ++b) line[b] += weight * in[b];
    }
    bool echoes = false;
    for (int b = 0; b < beams; ++b) echoes |= line[b] != 0.0f;
    if (!echoes) continue;
    const auto out = result.row(bin);
    for (int d = 0; d < beam_weights_.rows(); ++d) {
      const auto weights = beam_weights_.row(d);
      const float* shifted = padded.data() + d;
      for (int b = 0; b < beams; ++b) out[b] += weights[b] * shifted[b];
    }
  }
  return result;
}

}  // namespace ensonify
