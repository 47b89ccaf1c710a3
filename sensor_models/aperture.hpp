#pragma once

namespace ensonify {

/// Weighting of a line aperture (Harris 1978). First sidelobe: uniform -13.3 dB, hann -31.5 dB, hamming -42.7 dB;
/// gaussian has none. `box` is no aperture but the hard cut that simulators use: 1 inside the width, else 0.
enum class Shading { uniform, hann, hamming, gaussian, box };

/// Far-field power pattern of a line aperture, one way, 1 on its axis and 1/2 at +-width/2.
class Aperture {
 public:
  Aperture() = default;
  /// `width_rad`: full -3 dB width on the axis, in (0, pi).
  Aperture(Shading shading, double width_rad);

  /// Amplitude at an offset of sine_offset from the axis: 1 on it, negative in every other sidelobe.
  double amplitude(double sine_offset) const;
  /// Power at an offset of sine_offset = sin(theta) - sin(theta_0) from the axis.
  double power(double sine_offset) const;
  /// Sine offset where the main lobe ends: the first null; for gaussian -40 dB; for box the edge.
  double main_lobe_sine() const;
  /// Smallest sine offset, at most 1, beyond which the power stays below 10^(level_db / 10).
  double sine_beyond_db(double level_db) const;

  Shading shading() const { return shading_; }
  double width_rad() const { return width_rad_; }

 private:
  Shading shading_ = Shading::hann;
  double width_rad_ = 0;
  double scale_ = 1;  ///< aperture length in wavelengths (box, gaussian: 1 / half-width sine)
};

}  // namespace ensonify
