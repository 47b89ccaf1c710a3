#pragma once

#include <string>
#include <variant>
#include <vector>

#include "ensonify/core/echo.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {

/// level <- level * (1 + sigma N(0, 1)): the multiplicative speckle of HoloOcean, Stonefish and Lin et al. (ICRA 2023).
/// Acts after gamma, so it is no model of real speckle (see docs/noise.md).
struct GaussianSpeckle {
  double sigma = 0;
};

/// level <- level + Rayleigh(sigma): the additive noise of HoloOcean and Lin et al. (ICRA 2023). Mean 1.2533 sigma.
struct AdditiveRayleigh {
  double sigma = 0;
};

/// The closed set of disturbances. A new one is a struct here, one overload in noise_chain.cpp, one entry in its reader.
using NoiseStage = std::variant<GaussianSpeckle, AdditiveRayleigh>;

struct NoiseChain {
  std::string name;
  std::vector<NoiseStage> stages;  ///< applied in order
};

/// Loads a profile (path or bundled name). Throws ConfigError.
NoiseChain load_noise(const std::string& path_or_name);

/// Runs the chain on an image of levels 0..1 (rows = bins, columns = beams); the result is clipped to 0..1.
/// Numbers are addressed by (key, stage, bin, beam): a stage that is switched off changes no other stage's numbers.
Image2<float> disturb(const NoiseChain& chain, Image2<float> level, RandomKey key);

}  // namespace ensonify
