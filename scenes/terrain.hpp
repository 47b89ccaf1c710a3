#pragma once

#include "ensonify/core/pose.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {

/// Smooth noise on a unit lattice, rms near 0.2 (Perlin 2002 gradient noise, 3-D).
double gradient_noise(RandomKey key, const Vec3& p);

/// A seabed or sea surface as a function of the place. Zero heights switch a part off.
struct Terrain {
  double level_m = 0;                               ///< mean height
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dz/dx, dz/dy about `pivot_m`
  Eigen::Vector2d pivot_m = Eigen::Vector2d::Zero();
  double fractal_rms_m = 0;         ///< height deviation of the fractal part
  double fractal_wavelength_m = 5;  ///< its longest wavelength
  double fractal_finest_m = 0.2;    ///< its shortest wavelength
  double hurst = 0.9;               ///< 0 jagged .. 1 smooth; spectrum falls with k^-(2 hurst + 2)
  double ripple_height_m = 0;       ///< trough to crest
  double ripple_length_m = 0.5;
  double ripple_direction_rad = 0;  ///< across the crests, from +x
};

/// Height (m) at a place. Same key and place, same bits.
double terrain_height_m(const Terrain& terrain, RandomKey key, double x_m, double y_m);

}  // namespace ensonify
