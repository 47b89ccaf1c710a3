#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/core/image2.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {

/// level <- level * (1 + sigma N(0, 1)): the multiplicative speckle of HoloOcean, Stonefish and Lin et al. (ICRA 2023).
/// Acts after gamma, so it is no model of real speckle (see docs/noise.md).
template <typename Value>
struct GaussianSpeckle {
  static constexpr const char* kind = "gaussian_speckle";
  Value sigma;
  template <typename F>
  auto map(F&& f) const {
    return GaussianSpeckle<decltype(f("sigma", sigma))>{f("sigma", sigma)};
  }
};

/// level <- level + Rayleigh(sigma): the additive noise of HoloOcean and Lin et al. (ICRA 2023). Mean 1.2533 sigma.
template <typename Value>
struct AdditiveRayleigh {
  static constexpr const char* kind = "additive_rayleigh";
  Value sigma;
  template <typename F>
  auto map(F&& f) const {
    return AdditiveRayleigh<decltype(f("sigma", sigma))>{f("sigma", sigma)};
  }
};

/// The closed set of disturbances; Value is double, or Distribution before sampling. A new one is a struct here, an
/// entry in read_stage and an overload in RowDisturbance (noise_chain.cpp).
template <typename Value>
using NoiseStage = std::variant<GaussianSpeckle<Value>, AdditiveRayleigh<Value>>;

/// Stages in the order they act, every number fixed.
struct NoiseChain {
  std::string name;
  std::vector<NoiseStage<double>> stages;
};

/// Stages whose numbers may be distributions.
struct NoiseProfile {
  std::string name;
  std::vector<NoiseStage<Distribution>> stages;
};

using SampledValues = std::vector<std::pair<std::string, double>>;

/// Loads a profile (path or bundled name). Throws ConfigError.
NoiseProfile load_noise(const std::string& path_or_name);

/// Draws the numbers of a profile. What comes from a true distribution is appended to `sampled` as
/// "noise.<kind>.<parameter>".
NoiseChain sample_noise(const NoiseProfile& profile, RandomKey key, SampledValues& sampled);

/// Runs the chain on an image of levels 0..1 (rows = bins, columns = beams); the result is clipped to 0..1.
/// Numbers are addressed by (key, stage, bin, beam): a stage that is switched off changes no other stage's numbers.
Image2<float> disturb(const NoiseChain& chain, Image2<float> level, RandomKey key);

}  // namespace ensonify
