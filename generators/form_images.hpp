#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/sensor_models/point_spread.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// What one ping becomes. All of one size: rows = range bins, columns = beams.
struct PingImages {
  SonarImage clean;             ///< direct path, no noise, nominal gain
  SonarImage raw;               ///< with noise and gain
  Image2<std::uint8_t> mask;    ///< 255 exactly where clean.grey >= threshold, else 0
  Image2<std::uint8_t> labels;  ///< `PixelLabel`
};

struct ImageSettings {
  NoiseChain noise;
  double gain_db = 0;  ///< of the raw image
  int mask_threshold = 8;
};

/// Echo -> images. `key` addresses the noise.
PingImages form_images(const SonarModel& sonar, const PointSpread& spread, const Echo& echo, const PingTruth& truth,
                       const ImageSettings& settings, RandomKey key);

}  // namespace ensonify
