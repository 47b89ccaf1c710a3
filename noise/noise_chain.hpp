#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/noise/noise_stage.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {

/// Stages in the order they act, every number fixed. Domains never go back (see `NoiseDomain`).
struct NoiseChain {
  std::string name;
  std::vector<NoiseStage<double>> stages;

  /// Does any stage need more than the finished image: speckle, multipath, receiver, ...?
  bool acts_before_image() const;
  /// The stage of that kind, or null.
  template <template <typename> class Stage>
  const Stage<double>* find() const {
    for (const auto& stage : stages) {
      if (const auto* found = std::get_if<Stage<double>>(&stage)) return found;
    }
    return nullptr;
  }
};

/// Stages whose numbers may be distributions.
struct NoiseProfile {
  std::string name;
  std::vector<NoiseStage<Distribution>> stages;
};

using SampledValues = std::vector<std::pair<std::string, double>>;

/// Loads a profile. Throws ConfigError.
NoiseProfile load_noise(const ConfigSource& source);

/// Throws ConfigError where a stage does not fit the instrument: a stripe or a cross-talk period wider than the fan.
void check_noise(const NoiseProfile& profile, const SonarModel& sonar);

/// Draws the numbers of a profile. What comes from a true distribution is appended to `sampled` as
/// "noise.<kind>.<parameter>".
NoiseChain sample_noise(const NoiseProfile& profile, RandomKey key, SampledValues& sampled);

/// Names every stage by its kind and which of its kind it is, so that other stages do not shift its random numbers.
template <typename Value>
std::vector<std::string> stage_names(const std::vector<NoiseStage<Value>>& stages);
extern template std::vector<std::string> stage_names(const std::vector<NoiseStage<double>>&);
extern template std::vector<std::string> stage_names(const std::vector<NoiseStage<Distribution>>&);

template <typename Value>
NoiseDomain domain_of(const NoiseStage<Value>& stage) {
  return std::visit([](const auto& s) { return s.domain; }, stage);
}

}  // namespace ensonify
