#pragma once

#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Main lobe of a sonar's response to a point, in power: the shaded array's beam across azimuth (a kernel in
/// sin(theta), so it widens as 1 / cos(theta) off the axis) and the pulse across range (Gaussian of full width
/// c / (2 B) at half power, averaged over where in its bin the echo lies). A target on a beam's axis keeps its level
/// in that beam. Sidelobes are left out: they are no part of the clean image.
class PointSpread {
 public:
  explicit PointSpread(const SonarModel& sonar);

  Image2<float> apply(const Image2<float>& intensity) const;

  /// Weight by which beam b + d - reach() enters beam b, at (d, b): one diagonal of the band matrix a row.
  const Image2<float>& beam_weights() const { return beam_weights_; }
  int reach() const { return beam_weights_.rows() / 2; }
  /// Symmetric, sums to one, centre in the middle.
  const std::vector<float>& range_weights() const { return range_weights_; }

 private:
  Image2<float> beam_weights_;
  std::vector<float> range_weights_;
};

}  // namespace ensonify
