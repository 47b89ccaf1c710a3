#include "ensonify/scenes/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

double lattice_gradient(RandomKey key, const Eigen::Vector3i& cell, const Vec3& offset) {
  const auto words = random_words(key, static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                                  static_cast<std::uint32_t>(cell.z()));
  const auto component = [](std::uint32_t word) { return word * 0x1p-31 - 1.0; };
  return component(words[0]) * offset.x() + component(words[1]) * offset.y() + component(words[2]) * offset.z();
}

/// Sum of octaves with amplitude falling by 2^-hurst, scaled to an rms of about 1.
double fractal_noise(const Terrain& terrain, RandomKey key, double x_m, double y_m) {
  constexpr double gradient_noise_rms = 0.203;  // measured on the plane z = 0.5
  const double gain = std::pow(2.0, -terrain.hurst);
  double sum = 0, power = 0, amplitude = 1;
  double wavelength = terrain.fractal_wavelength_m;
  for (std::uint64_t octave = 0; octave < 12 && (octave == 0 || wavelength >= terrain.fractal_finest_m); ++octave) {
    // Off the lattice planes, where gradient noise is 0.
    const Vec3 p(x_m / wavelength + 0.37, y_m / wavelength + 0.71, 0.5);
    sum += amplitude * gradient_noise(key.child(octave), p);
    power += amplitude * amplitude;
    amplitude *= gain;
    wavelength *= 0.5;
  }
  return sum / (gradient_noise_rms * std::sqrt(power));
}

/// Crests are sharper than troughs, wander and vary in height, as ripples of sand under waves do.
double ripple_m(const Terrain& terrain, RandomKey key, double x_m, double y_m) {
  const double length = terrain.ripple_length_m;
  const Vec3 p(x_m / (6.0 * length), y_m / (6.0 * length), 0.5);
  const double wander = 5.0 * gradient_noise(key.child("wander"), p);
  const double strength = std::clamp(0.8 + 1.2 * gradient_noise(key.child("strength"), p), 0.1, 1.0);
  const double across = x_m * std::cos(terrain.ripple_direction_rad) + y_m * std::sin(terrain.ripple_direction_rad);
  const double phase = 2.0 * std::numbers::pi * across / length + wander;
  return 0.5 * terrain.ripple_height_m * strength * (std::cos(phase) + 0.2 * std::cos(2.0 * phase)) / 1.2;
}

}  // namespace

double gradient_noise(RandomKey key, const Vec3& p) {
  const Vec3 floor = p.array().floor();
  const Eigen::Vector3i cell = floor.cast<int>();
  const Vec3 t = p - floor;
  const Vec3 w(fade(t.x()), fade(t.y()), fade(t.z()));
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const double weight =
        (step.x() ? w.x() : 1 - w.x()) * (step.y() ? w.y() : 1 - w.y()) * (step.z() ? w.z() : 1 - w.z());
    sum += weight * lattice_gradient(key, cell + step, t - step.cast<double>());
  }
  return sum;
}

double terrain_height_m(const Terrain& terrain, RandomKey key, double x_m, double y_m) {
  double height = terrain.level_m + terrain.slope.dot(Eigen::Vector2d(x_m, y_m) - terrain.pivot_m);
  if (terrain.fractal_rms_m > 0) {
    height += terrain.fractal_rms_m * fractal_noise(terrain, key.child("fractal"), x_m, y_m);
  }
  if (terrain.ripple_height_m > 0) height += ripple_m(terrain, key.child("ripple"), x_m, y_m);
  return height;
}

}  // namespace ensonify
