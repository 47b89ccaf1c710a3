#pragma once

#include <vector>

namespace ensonify {

/// Beam azimuths (rad, descending, port-most first) whose outermost beams point to +-fov/2.
/// Equal steps of the angle.
std::vector<double> uniform_angle_beams(int count, double fov_rad);
/// Equal steps of sin(theta), as a line array forms them (measured on the Oculus: within 0.01 deg).
std::vector<double> uniform_sine_beams(int count, double fov_rad);

}  // namespace ensonify
