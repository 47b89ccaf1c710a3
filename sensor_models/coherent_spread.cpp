#include "ensonify/sensor_models/coherent_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ensonify/sensor_models/point_spread.hpp"

namespace ensonify {
namespace {

constexpr double least_amplitude = 1e-3;  // -60 dB
/// An unshaded array's sidelobes would reach over the whole fan; beyond this they are left to `sidelobe_arcs`.
constexpr int farthest_beams = 64;
constexpr double nominal_sound_speed_mps = 1490.0;
/// Bins at least this long, in pulse lengths, hold uncorrelated samples.
constexpr double independent_bin = 0.75;

Image2<float> amplitude_band(const Aperture& aperture, const std::vector<double>& azimuth) {
  const int beams = static_cast<int>(azimuth.size());
  const double reach_sine = aperture.sine_beyond_db(20.0 * std::log10(least_amplitude));
  int reach = 0;
  for (int b = 0; b < beams; ++b) {
    while (reach < farthest_beams && b + reach + 1 < beams &&
           std::sin(azimuth[b]) - std::sin(azimuth[b + reach + 1]) <= reach_sine)
      ++reach;
  }
  Image2<float> band(2 * reach + 1, beams);
  for (int d = 0; d < band.rows(); ++d) {
    for (int b = std::max(0, reach - d); b < std::min(beams, beams + reach - d); ++b) {
      const double offset = std::sin(azimuth[b + d - reach]) - std::sin(azimuth[b]);
      band(d, b) = std::abs(offset) <= reach_sine ? static_cast<float>(aperture.amplitude(offset)) : 0.0f;
    }
  }
  return band;
}

Image2<float> beyond_main_lobe(const Image2<float>& band, const Aperture& aperture,
                               const std::vector<double>& azimuth) {
  Image2<float> power(band.rows(), band.columns());
  const int reach = band.rows() / 2;
  for (int d = 0; d < band.rows(); ++d) {
    for (int b = std::max(0, reach - d); b < std::min(band.columns(), band.columns() + reach - d); ++b) {
      const double offset = std::abs(std::sin(azimuth[b + d - reach]) - std::sin(azimuth[b]));
      power(d, b) = offset > aperture.main_lobe_sine() ? band(d, b) * band(d, b) : 0.0f;
    }
  }
  return power;
}

std::vector<float> pulse_amplitudes(const SonarModel& sonar) {
  std::vector<float> pulse = PointSpread(sonar).range_weights();
  for (float& p : pulse) p = std::sqrt(p);
  const double pulse_bins = nominal_sound_speed_mps / (2.0 * sonar.bandwidth_hz) / sonar.geometry.bin_size_m();
  if (pulse_bins * independent_bin <= 1.0) {
    for (std::size_t k = 0; k < pulse.size() / 2; ++k) pulse[k] = -pulse[k];
  }
  return pulse;
}

/// Rows smeared along range, with `reach` zeros on either side.
Image2<float> spread_range(const Image2<float>& in, const std::vector<float>& taps, int reach) {
  const int range_reach = static_cast<int>(taps.size()) / 2;
  Image2<float> result(in.rows(), in.columns() + 2 * reach);
  for (int bin = 0; bin < in.rows(); ++bin) {
    float* __restrict line = result.row(bin).data() + reach;
    for (int k = std::max(-range_reach, -bin); k <= std::min(range_reach, in.rows() - 1 - bin); ++k) {
      const float* __restrict row = in.row(bin + k).data();
      const float weight = taps[static_cast<std::size_t>(k + range_reach)];
      for (int b = 0; b < in.columns(); ++b) line[b] += weight * row[b];
    }
  }
  return result;
}

/// Part of the diagonals, from `first` up to `end`.
struct Diagonals {
  int first, end;
};

/// Runs of diagonals that give these beams anything: the main lobe is left out of the sidelobes' power.
std::vector<Diagonals> runs_of_diagonals(const Image2<float>& band, int beam, int beams) {
  std::vector<Diagonals> runs;
  for (int d = 0; d < band.rows(); ++d) {
    const auto weights = band.row(d).subspan(static_cast<std::size_t>(beam), static_cast<std::size_t>(beams));
    if (std::all_of(weights.begin(), weights.end(), [](float w) { return w == 0.0f; })) continue;
    if (runs.empty() || runs.back().end != d) runs.push_back({d, d});
    runs.back().end = d + 1;
  }
  return runs;
}

/// Range taps, then the band matrix: a few beams of all rows at a time, so that their weights stay at hand and their
/// sums in registers.
Image2<float> spread(const Image2<float>& in, const std::vector<float>& taps, const Image2<float>& band) {
  constexpr int chunk = 32;
  const int beams = in.columns();
  const int diagonals = band.rows();
  const Image2<float> padded = spread_range(in, taps, diagonals / 2);
  Image2<float> result(in.rows(), beams);
  int b = 0;
  for (; b + chunk <= beams; b += chunk) {
    const std::vector<Diagonals> runs = runs_of_diagonals(band, b, chunk);
    for (int bin = 0; bin < in.rows(); ++bin) {
      const float* __restrict line = padded.row(bin).data() + b;
      std::array<float, chunk> sum{};
      for (const auto [first, end] : runs) {
        for (int d = first; d < end; ++d) {
          const float* __restrict weight = band.row(d).data() + b;
          for (int i = 0; i < chunk; ++i) sum[i] += weight[i] * line[d + i];
        }
      }
      std::copy(sum.begin(), sum.end(), result.row(bin).data() + b);
    }
  }
  for (int bin = 0; bin < in.rows(); ++bin) {
    for (int rest = b; rest < beams; ++rest) {
      for (int d = 0; d < diagonals; ++d) result(bin, rest) += band(d, rest) * padded(bin, rest + d);
    }
  }
  return result;
}

}  // namespace

CoherentSpread::CoherentSpread(const SonarModel& sonar)
    : amplitude_(amplitude_band(sonar.receive_azimuth, sonar.geometry.beam_azimuth_rad)),
      sidelobe_power_(beyond_main_lobe(amplitude_, sonar.receive_azimuth, sonar.geometry.beam_azimuth_rad)),
      pulse_(pulse_amplitudes(sonar)) {
  double beams = 0.0;
  for (int d = 0; d < amplitude_.rows(); ++d) {
    const auto a = static_cast<double>(amplitude_(d, amplitude_.columns() / 2));
    beams += a * a;
  }
  double range = 0.0;
  for (const float p : pulse_) range += static_cast<double>(p) * static_cast<double>(p);
  noise_gain_ = beams * range;
}

ComplexField CoherentSpread::apply(const ComplexField& field) const {
  ComplexField result(0, 0);
  result.real = spread(field.real, pulse_, amplitude_);
  result.imaginary = spread(field.imaginary, pulse_, amplitude_);
  return result;
}

Image2<float> CoherentSpread::sidelobe_power(const Image2<float>& intensity) const {
  std::vector<float> taps = pulse_;
  for (float& t : taps) t *= t;
  return spread(intensity, taps, sidelobe_power_);
}

}  // namespace ensonify
