#pragma once

#include <optional>
#include <vector>

#include "ensonify/core/pose.hpp"

namespace ensonify {

/// A point of the sonar frame in range (m), azimuth theta and elevation phi (rad):
/// x = r cos(phi) cos(theta), y = r cos(phi) sin(theta), z = r sin(phi).
struct Spherical {
  double range_m = 0;
  double azimuth_rad = 0;
  double elevation_rad = 0;
};

Spherical to_spherical(const Vec3& p_sonar);
Vec3 from_spherical(const Spherical& s);

/// How a multibeam sonar samples range and azimuth; elevation is lost in the image.
///
///            x forward (theta = 0)         row k    : range bin [r0 + k dr, r0 + (k+1) dr)
///   beam 0    |    last beam               column b : beam, port-most (largest theta) first
///        \    |    /                       elevation: -fov/2 .. fov/2, the nominal -3 dB width
///   y left <--o
///
/// Beams need not be evenly spaced.
struct SonarGeometry {
  double range_min_m = 0;
  double range_max_m = 0;
  int range_bins = 0;
  std::vector<double> beam_azimuth_rad;  ///< strictly descending
  double elevation_fov_rad = 0;

  int beams() const { return static_cast<int>(beam_azimuth_rad.size()); }
  double bin_size_m() const { return (range_max_m - range_min_m) / range_bins; }
  double bin_start_m(int bin) const { return range_min_m + bin * bin_size_m(); }
  double bin_centre_m(int bin) const { return range_min_m + (bin + 0.5) * bin_size_m(); }

  /// Range bin that holds `range_m`; empty outside [range_min_m, range_max_m).
  std::optional<int> bin_of(double range_m) const;
  /// Beam whose cell holds `azimuth_rad`; empty outside the fan.
  std::optional<int> beam_of(double azimuth_rad) const;
  /// The beams() + 1 cell borders (rad, descending): midway between neighbours, mirrored at the ends.
  std::vector<double> beam_edges_rad() const;
};

}  // namespace ensonify
