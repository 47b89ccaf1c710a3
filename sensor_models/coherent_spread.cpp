#include "ensonify/sensor_models/coherent_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ensonify/core/lanes.hpp"
#include "ensonify/sensor_models/fan_border.hpp"
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
  std::vector<double> gain = border_gain(
      azimuth, reach, [&](double offset) { return std::abs(offset) <= reach_sine ? aperture.power(offset) : 0.0; });
  for (double& g : gain) g = std::sqrt(g);
  scale_beams(band, gain);
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

constexpr int vectors = 4;
constexpr int chunk = vectors * lane_count;  ///< beams whose sums stay in registers

/// The sums of `chunk` beams from `beam` on, in two rows that share the weights.
void sum_diagonals(const Image2<float>& band, const std::vector<Diagonals>& runs, int beam, const float* line0,
                   const float* line1, float* out0, float* out1) {
  std::array<Lanes, vectors> sum0{}, sum1{};
  for (const Diagonals& run : runs) {
    for (int d = run.first; d < run.end; ++d) {
      const float* w = band.row(d).data() + beam;
      const float* x0 = line0 + beam + d;
      const float* x1 = line1 + beam + d;
      for (int v = 0; v < vectors; ++v) {
        const Lanes weight = lanes_of(w + v * lane_count);
        sum0[v] = fused(weight, lanes_of(x0 + v * lane_count), sum0[v]);
        sum1[v] = fused(weight, lanes_of(x1 + v * lane_count), sum1[v]);
      }
    }
  }
  for (int v = 0; v < vectors; ++v) {
    store(sum0[v], out0 + beam + v * lane_count);
    store(sum1[v], out1 + beam + v * lane_count);
  }
}

/// The sum of one beam.
float sum_diagonals(const Image2<float>& band, int beam, const float* line) {
  float sum = 0.0f;
  for (int d = 0; d < band.rows(); ++d) sum = std::fma(band(d, beam), line[beam + d], sum);
  return sum;
}

/// A row smeared along range.
void spread_range(const Image2<float>& in, const std::vector<float>& taps, int bin, float* __restrict line) {
  const int reach = static_cast<int>(taps.size()) / 2;
  std::fill(line, line + in.columns(), 0.0f);
  for (int k = std::max(-reach, -bin); k <= std::min(reach, in.rows() - 1 - bin); ++k) {
    const float* __restrict row = in.row(bin + k).data();
    const float weight = taps[static_cast<std::size_t>(k + reach)];
    for (int b = 0; b < in.columns(); ++b) line[b] += weight * row[b];
  }
}

/// Range taps, then the band matrix, a few rows at a time, so that they stay at hand.
Image2<float> spread(const Image2<float>& in, const std::vector<float>& taps, const Image2<float>& band) {
  constexpr int together = 8;
  const int beams = in.columns();
  const int reach = band.rows() / 2;
  std::vector<std::vector<Diagonals>> runs;
  for (int b = 0; b + chunk <= beams; b += chunk) runs.push_back(runs_of_diagonals(band, b, chunk));
  const int in_chunks = chunk * static_cast<int>(runs.size());
  Image2<float> lines(together, beams + 2 * reach);  // zeros on either side
  std::vector<float> no_row(static_cast<std::size_t>(beams));
  Image2<float> result(in.rows(), beams);
  for (int first = 0; first < in.rows(); first += together) {
    const int rows = std::min(together, in.rows() - first);
    for (int r = 0; r < rows; ++r) spread_range(in, taps, first + r, lines.row(r).data() + reach);
    for (int r = 0; r < rows; r += 2) {
      const float* line0 = lines.row(r).data();
      const float* line1 = lines.row(r + 1).data();
      float* out0 = result.row(first + r).data();
      float* out1 = r + 1 < rows ? result.row(first + r + 1).data() : no_row.data();
      for (int b = 0; b < in_chunks; b += chunk) {
        sum_diagonals(band, runs[static_cast<std::size_t>(b / chunk)], b, line0, line1, out0, out1);
      }
      for (int b = in_chunks; b < beams; ++b) {
        out0[b] = sum_diagonals(band, b, line0);
        out1[b] = sum_diagonals(band, b, line1);
      }
    }
  }
  return result;
}

}  // namespace

CoherentSpread::CoherentSpread(const SonarModel& sonar)
    : amplitude_(amplitude_band(sonar.receive_azimuth, sonar.geometry.beam_azimuth_rad)),
      sidelobe_power_(beyond_main_lobe(amplitude_, sonar.receive_azimuth, sonar.geometry.beam_azimuth_rad)),
      pulse_(pulse_amplitudes(sonar)) {
  double range = 0.0;
  for (const float p : pulse_) range += static_cast<double>(p) * static_cast<double>(p);
  noise_gain_.assign(static_cast<std::size_t>(amplitude_.columns()), 0.0);
  for (int d = 0; d < amplitude_.rows(); ++d) {
    for (std::size_t b = 0; b < noise_gain_.size(); ++b) {
      const auto a = static_cast<double>(amplitude_(d, static_cast<int>(b)));
      noise_gain_[b] += a * a * range;
    }
  }
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
