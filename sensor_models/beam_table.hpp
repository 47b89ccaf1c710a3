#pragma once

#include <vector>

namespace ensonify {

/// Beam azimuths (rad, descending, port-most first) whose outermost beams point to +-fov/2.
/// Equal steps of the angle.
std::vector<double> uniform_angle_beams(int count, double fov_rad);
/// Equal steps of sin(theta), as a line array forms them (measured on the Oculus: within 0.01 deg).
std::vector<double> uniform_sine_beams(int count, double fov_rad);

/// The widest step from a beam to the next one to starboard, in -3 dB widths. Counted in sin(azimuth), where beams are
/// equally wide.
struct BeamGap {
  int after_beam = 0;
  double widths = 0;
};
BeamGap widest_gap(const std::vector<double>& azimuth_rad, double width_rad);

}  // namespace ensonify
