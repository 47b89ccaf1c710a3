#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ensonify/core/error.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"

namespace ensonify {
namespace {

using testing::HasSubstr;

std::filesystem::path file_with(const std::string& stages) {
  const auto path = std::filesystem::path(testing::TempDir()) / "profile.yaml";
  std::ofstream(path) << "name: mine\nstages:\n" << stages;
  return path;
}

std::string refusal(const std::string& stages) {
  try {
    const NoiseProfile profile = load_noise(file_with(stages).string());
    check_noise(profile, load_sonar("oculus_m1200d_hf"));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

// Each message names the file and line, and the rule.
TEST(NoiseProfile, RefusesWhatBreaksARule) {
  EXPECT_THAT(refusal("  - {stage: gaussian_speckle, sigma: -0.1}\n"), HasSubstr("profile.yaml:3"));
  EXPECT_THAT(refusal("  - {stage: gaussian_speckle, sigma: -0.1}\n"), HasSubstr("0"));
  EXPECT_THAT(refusal("  - {stage: gain_wobble, sigma: {uniform: [-0.1, 0.2]}}\n"), HasSubstr("sigma"));
  EXPECT_THAT(refusal("  - {stage: coherent_spekle}\n"), HasSubstr("coherent_speckle"));
  EXPECT_THAT(refusal("  - {stage: receiver_noise}\n"), HasSubstr("level_db"));
  EXPECT_THAT(refusal("  - {stage: ring_down, level_db: -40, decay_m: 0.1, decay: 3}\n"), HasSubstr("decay"));
  EXPECT_THAT(refusal("  - {stage: multipath, order: 4}\n"), HasSubstr("order"));
  EXPECT_THAT(refusal("  - {stage: cross_talk, level_db: -20, period_beams: 512}\n"), HasSubstr("wider than the fan"));
  EXPECT_THAT(refusal("  - {stage: centre_stripe, gain: 2, width_beams: {uniform: [1, 600]}}\n"),
              HasSubstr("wider than the fan"));
  EXPECT_EQ(refusal("  - {stage: cross_talk, level_db: -20, period_beams: 511}\n"), "accepted");
}

TEST(NoiseProfile, KeepsTheOrderOfPhysics) {
  EXPECT_THAT(refusal("  - {stage: gaussian_speckle, sigma: 0.1}\n  - {stage: coherent_speckle}\n"),
              HasSubstr("can not follow"));
  EXPECT_THAT(refusal("  - {stage: receiver_noise, level_db: -30}\n  - {stage: multipath}\n"),
              HasSubstr("can not follow"));
  EXPECT_THAT(refusal("  - {stage: coherent_speckle}\n  - {stage: rayleigh_speckle}\n"),
              HasSubstr("one speckle stage"));
}

// Every bundled profile loads, fits every bundled Oculus, and draws the same numbers for the same key.
TEST(NoiseProfile, BundledOnesLoad) {
  for (const char* name : {"none", "paper", "holoocean", "oculus_tank", "oculus_open_water", "harsh"}) {
    const NoiseProfile profile = load_noise(name);
    EXPECT_EQ(profile.name, name);
    check_noise(profile, load_sonar("oculus_m1200d_hf_256"));
    SampledValues first, again;
    const NoiseChain chain = sample_noise(profile, RandomKey::from_seed(3), first);
    sample_noise(profile, RandomKey::from_seed(3), again);
    EXPECT_EQ(first, again);
    EXPECT_EQ(chain.stages.size(), profile.stages.size());
  }
}

// HoloOcean's documented example: MultSigma 0.2, AddSigma 0.15, RangeSigma 0.1, MultiPath, AzimuthStreaks -1.
TEST(NoiseProfile, HoloOceanHasTheDocumentedValues) {
  SampledValues sampled;
  const NoiseChain chain = sample_noise(load_noise("holoocean"), RandomKey{}, sampled);
  EXPECT_TRUE(sampled.empty());
  EXPECT_EQ(chain.find<GaussianSpeckle>()->sigma, 0.2);
  EXPECT_EQ(chain.find<AdditiveRayleigh>()->sigma, 0.15);
  EXPECT_EQ(chain.find<RangeJitter>()->sigma_m, 0.1);
  EXPECT_EQ(chain.find<AzimuthStreaks>()->strength, -1.0);
  EXPECT_NE(chain.find<Multipath>(), nullptr);
}

}  // namespace
}  // namespace ensonify
