#include "ensonify/sensor_models/fan_border.hpp"

#include <cmath>
#include <numbers>

namespace ensonify {

std::vector<double> border_gain(const std::vector<double>& azimuth_rad, int reach_beams,
                                const std::function<double(double)>& power) {
  const int beams = static_cast<int>(azimuth_rad.size());
  std::vector<double> gain(azimuth_rad.size(), 1.0);
  if (beams < 2) return gain;
  const auto azimuth_of = [&](int beam) {
    if (beam < 0) return azimuth_rad[0] - beam * (azimuth_rad[0] - azimuth_rad[1]);
    if (beam < beams) return azimuth_rad[beam];
    return azimuth_rad[beams - 1] - (beam - beams + 1) * (azimuth_rad[beams - 2] - azimuth_rad[beams - 1]);
  };
  for (int b = 0; b < beams; ++b) {
    if (b >= reach_beams && b + reach_beams < beams) continue;
    double heard = 0.0, beyond = 0.0;
    for (int from = b - reach_beams; from <= b + reach_beams; ++from) {
      const double azimuth = azimuth_of(from);
      if (std::abs(azimuth) > 0.5 * std::numbers::pi) continue;
      const double of_this = power(std::sin(azimuth) - std::sin(azimuth_rad[b]));
      (from >= 0 && from < beams ? heard : beyond) += of_this;
    }
    if (heard > 0.0) gain[b] = (heard + beyond) / heard;
  }
  return gain;
}

void scale_beams(Image2<float>& band, const std::vector<double>& gain) {
  for (int d = 0; d < band.rows(); ++d) {
    for (int b = 0; b < band.columns(); ++b) band(d, b) *= static_cast<float>(gain[b]);
  }
}

}  // namespace ensonify
