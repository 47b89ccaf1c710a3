#include "ensonify/sensor_models/aperture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

double sinc(double x) {
  const double a = std::numbers::pi * x;
  return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

/// Amplitude of a raised-cosine window a0 + (1 - a0) cos, x = (length / wavelength) sin(theta).
double raised_cosine(double x, double a0) { return sinc(x) + 0.5 * (1.0 - a0) / a0 * (sinc(x - 1.0) + sinc(x + 1.0)); }

double shaded_amplitude(Shading shading, double x) {
  switch (shading) {
    case Shading::uniform:
      return sinc(x);
    case Shading::hann:
      return raised_cosine(x, 0.5);
    case Shading::hamming:
      return raised_cosine(x, 0.54);
    case Shading::gaussian:
      return std::exp(-0.25 * std::numbers::ln2 * 2.0 * x * x);  // power 1/2 at x = 1
    case Shading::box:
      return std::abs(x) <= 1.0 ? 1.0 : 0.0;
  }
  return 0.0;
}

/// Where the amplitude falls to 1/sqrt(2): the main lobe is monotone below x = 1.
double half_power_point(Shading shading) {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (shaded_amplitude(shading, middle) > std::numbers::sqrt2 / 2.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Aperture::Aperture(Shading shading, double width_rad)
    : shading_(shading),
      width_rad_(width_rad),
      scale_((shading == Shading::box || shading == Shading::gaussian ? 1.0 : half_power_point(shading)) /
             std::sin(0.5 * width_rad)) {}

double Aperture::amplitude(double sine_offset) const { return shaded_amplitude(shading_, scale_ * sine_offset); }

double Aperture::power(double sine_offset) const {
  const double a = amplitude(sine_offset);
  return a * a;
}

double Aperture::main_lobe_sine() const {
  switch (shading_) {
    case Shading::uniform:
    case Shading::box:
      return 1.0 / scale_;
    case Shading::hann:
    case Shading::hamming:
      return 2.0 / scale_;
    case Shading::gaussian:
      return sine_beyond_db(-40.0);
  }
  return 1.0 / scale_;
}

double Aperture::sine_beyond_db(double level_db) const {
  const double level = std::pow(10.0, level_db / 10.0);
  constexpr int steps = 20000;
  for (int i = steps; i > 0; --i) {
    if (power(static_cast<double>(i) / steps) >= level) return std::min(1.0, static_cast<double>(i + 1) / steps);
  }
  return 1.0 / steps;
}

}  // namespace ensonify
