#pragma once

#include <vector>

#include "ensonify/core/complex_field.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Smears a field of independent scatterers as array and pulse do, in complex amplitude. Across beams: the receiving
/// aperture's own pattern with its sidelobes, to -60 dB and at most 64 beams away. Along range: amplitudes whose
/// squares are PointSpread's weights, so that the mean power of the main lobe is what the clean image shows; where bins
/// are as long as the pulse, the two halves have opposite signs, because samples of a matched filter at its own
/// bandwidth are uncorrelated (Woodward 1953).
class CoherentSpread {
 public:
  explicit CoherentSpread(const SonarModel& sonar);

  ComplexField apply(const ComplexField& field) const;

  /// Mean power that the sidelobes receive from a layer of mean intensity: what `apply` gives beyond the main lobe.
  Image2<float> sidelobe_power(const Image2<float>& intensity) const;

  /// Mean power of each beam for a field of unit mean power everywhere.
  const std::vector<double>& noise_gain() const { return noise_gain_; }

 private:
  Image2<float> amplitude_;       ///< diagonal d of the band matrix in row d, as in PointSpread
  Image2<float> sidelobe_power_;  ///< squares of it, main lobe left out
  std::vector<float> pulse_;      ///< centre in the middle
  std::vector<double> noise_gain_;
};

}  // namespace ensonify
