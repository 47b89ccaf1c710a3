#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ensonify/config/library.hpp"
#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/sensor_models/aperture.hpp"

namespace ensonify {

/// From received intensity to pixels.
///   level [dB] = source level + 10 log10(echo) + g log10(r) + 2 alpha r - saturation level
///   pixel      = quantise(clip(10^(level / 20), 0, 1)^gamma)
struct ReceiveChain {
  double tvg_spreading_db = 40;        ///< g: 40 flattens point targets, 30 areas
  double tvg_absorption_db_per_m = 0;  ///< alpha the device compensates with
  double saturation_level_db = 190;    ///< level (after TVG) of a full-scale pixel
  double gamma = 0.5;                  ///< 1: pixel proportional to pressure amplitude
  int bits = 8;                        ///< of the stored grey value
};

/// How densely rays sample the fan. Zero: from the instrument's resolution (see `RayFan`).
struct RaySampling {
  int azimuth_rays_per_beam = 0;
  int elevation_rays = 0;
};

/// An instrument and its settings for one ping.
struct SonarModel {
  std::string name;
  std::string title;
  SonarGeometry geometry;
  double frequency_hz = 0;
  double bandwidth_hz = 0;     ///< range resolution c / (2 B)
  double source_level_db = 0;  ///< dB re 1 uPa at 1 m
  double native_bin_m = 0;     ///< range bin of the device
  double instrument_range_min_m = 0;
  double instrument_range_max_m = 0;
  Aperture receive_azimuth;  ///< of one beam
  Aperture elevation;        ///< transmitter and receiver alike: the two-way pattern is its square
  double fan_edge_db = 0;    ///< two-way loss at the edge of the fan, quadratic in azimuth from 0 at the centre
  ReceiveChain receive;
  RaySampling rays;
  double ping_rate_hz = 0;
  std::vector<std::string> unverified;  ///< keys whose values are from memory or assumed
};

/// Settings of one ping; what is not set stays as the instrument's YAML has it.
struct RangeWindow {
  std::optional<double> range_min_m;
  std::optional<double> range_max_m;
  std::optional<int> range_bins;  ///< 0: native bins; range_max_m is then rounded down to whole bins
};

/// Loads an instrument. Throws ConfigError.
SonarModel load_sonar(const ConfigSource& source, const RangeWindow& window = {});

}  // namespace ensonify
