#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/noise/ping_setting.hpp"
#include "ensonify/sim/trace_ping.hpp"

namespace ensonify {

/// What one ping becomes. All of one size: rows = range bins, columns = beams.
struct PingImages {
  SonarImage clean;             ///< direct path, no noise, nominal gain
  SonarImage raw;               ///< with noise and gain
  Image2<std::uint8_t> mask;    ///< 255 exactly where clean.grey >= threshold, else 0
  Image2<std::uint8_t> labels;  ///< `PixelLabel`
  Image2<float> multipath;      ///< mean power in the raw image, before the point spread; empty without such a stage
  Image2<float> sidelobe;       ///< mean power through sidelobes and leaks; empty where the noise models none
};

/// Grey level.
inline constexpr int default_mask_threshold = 8;

struct ImageSettings {
  NoiseChain noise;
  double gain_db = 0;  ///< of the raw image
  int mask_threshold = default_mask_threshold;
};

/// What a trace must give for the chain.
TraceOptions trace_options(const NoiseChain& noise, bool cell_truth);

/// Echo -> images.
PingImages form_images(const Receiver& receiver, const Ping& ping, const ImageSettings& settings,
                       const PingSetting& setting);

}  // namespace ensonify
