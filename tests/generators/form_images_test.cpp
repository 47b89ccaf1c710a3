#include "ensonify/generators/form_images.hpp"

#include <gtest/gtest.h>

#include "ensonify/sensor_models/receive_chain.hpp"
#include "support/meshes.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

SonarModel instrument() {
  SonarModel sonar = bare_sonar({.bins = 512});
  sonar.receive = {40.0, 0.0, 175.0, 0.5, 8};
  return sonar;
}

struct Formed {
  Ping ping;
  PingImages images;
};

Formed form(const ImageSettings& settings, const SonarModel& sonar = instrument()) {
  Ping ping = ping_of(
      scene_of({floor_mesh(-0.8), moved(sphere_mesh(0.5), {4.0, 0, -0.3}), wall_mesh({8.0, 0, 0}, {-1, 0.3, 0})}),
      sonar);
  PingImages images = form_images(Receiver(sonar), ping, settings, {.ping = RandomKey::from_seed(1)});
  return {std::move(ping), std::move(images)};
}

// mask = 255 exactly where clean >= threshold; label = direct there, else shadow from shadow_start on, else water.
TEST(FormImages, MaskAndLabelsKeepTheirRules) {
  for (const int threshold : {1, 8, 100, 255}) {
    ImageSettings settings;
    settings.noise.stages = {GaussianSpeckle<double>{0.25}, AdditiveRayleigh<double>{0.05}};
    settings.mask_threshold = threshold;
    const Formed f = form(settings);
    int echoes = 0, shadows = 0, water = 0;
    for (int bin = 0; bin < f.images.mask.rows(); ++bin) {
      for (int b = 0; b < f.images.mask.columns(); ++b) {
        const bool bright = f.images.clean.grey(bin, b) >= threshold;
        ASSERT_EQ(f.images.mask(bin, b), bright ? 255 : 0);
        const int expected = bright ? 1 : bin >= f.ping.truth.shadow_start_bin[b] ? 4 : 0;
        ASSERT_EQ(f.images.labels(bin, b), expected);
        echoes += expected == 1;
        shadows += expected == 4;
        water += expected == 0;
      }
    }
    if (threshold == 8) {
      EXPECT_GT(echoes, 1000);
      EXPECT_GT(shadows, 100);
      EXPECT_GT(water, 1000);
    }
  }
}

TEST(FormImages, CleanKnowsNeitherNoiseNorGain) {
  ImageSettings plain;
  ImageSettings disturbed;
  disturbed.noise.stages = {GaussianSpeckle<double>{0.25}};
  disturbed.gain_db = 12.0;
  const Formed a = form(plain);
  const Formed b = form(disturbed);
  EXPECT_EQ(a.images.clean.grey, b.images.clean.grey);
  EXPECT_EQ(a.images.mask, b.images.mask);
  EXPECT_EQ(a.images.raw.level, a.images.clean.level);
  EXPECT_NE(b.images.raw.grey, b.images.clean.grey);
  EXPECT_EQ(b.images.raw.grey, quantise(b.images.raw.level));
}

// A gain of G dB multiplies amplitude by 10^(G / 20), the pixel by that to the power of gamma, up to full scale.
TEST(FormImages, GainOfTheRawImage) {
  ImageSettings settings;
  settings.gain_db = 6.0;
  const Formed f = form(settings);
  const double factor = std::pow(10.0, 6.0 / 20.0 * 0.5);
  for (std::size_t i = 0; i < f.images.raw.level.size(); ++i) {
    const auto clean = static_cast<double>(f.images.clean.level.pixels()[i]);
    if (clean >= 1.0) continue;
    ASSERT_NEAR(static_cast<double>(f.images.raw.level.pixels()[i]), std::min(1.0, clean * factor), 1e-5);
  }
}

}  // namespace
}  // namespace ensonify
