// Seed 2024. Kolmogorov-Smirnov tests at alpha = 0.001 on pixels far enough apart to be independent. The seed is fixed,
// so the outcome is too.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/noise/disturb_echo.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "support/pings.hpp"
#include "support/statistics.hpp"

namespace ensonify {
namespace {

using namespace test;

/// 256 beams uniform in sine, bins of the pulse's length, two beams a beam width: as the Oculus has them.
SonarModel instrument() {
  SonarModel sonar = bare_sonar({.range_min_m = 2.0, .range_max_m = 2.0 + 512 * 0.002842, .bins = 512});
  sonar.geometry.beam_azimuth_rad = uniform_sine_beams(256, radians(60.0));
  sonar.receive = {40.0, 0.0, 175.0, 0.5, 8};
  return sonar;
}

Echo even_echo(const SonarModel& sonar) {
  return {Image2<float>(sonar.geometry.range_bins, sonar.geometry.beams(), 1e-6F), {}, {}};
}

NoiseChain chain_of(std::vector<NoiseStage<double>> stages) { return {"test", std::move(stages)}; }

PingSetting setting_of(std::uint64_t seed, const Pose& T_world_sonar = Pose::Identity()) {
  const RandomKey key = RandomKey::from_seed(seed);
  return {T_world_sonar, key.child("surface"), key.child("device"), key.child("ping")};
}

/// Pixels `beam_step` beams and `bin_step` bins apart, over their mean; without the beams at the edges.
std::vector<double> pixels_apart(const Image2<float>& power, int beam_step, int bin_step = 1) {
  std::vector<double> x;
  for (int bin = 4; bin < power.rows() - 4; bin += bin_step) {
    for (int b = 10; b < power.columns() - 10; b += beam_step) x.push_back(static_cast<double>(power(bin, b)));
  }
  const double mean = mean_of(x);
  for (double& v : x) v /= mean;
  return x;
}

// Intensity of fully developed speckle is exponential (Goodman 2007, 3.2): <I^2>/<I>^2 = 2; the amplitude is Rayleigh.
// Beams four apart and bins two apart are independent (Hann: the field's correlation is below 0.01).
TEST(CoherentSpeckle, IsFullyDeveloped) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  std::vector<double> all;
  for (std::uint64_t seed = 2024; seed < 2044; ++seed) {
    const auto received =
        disturb_echo(chain_of({CoherentSpeckle<double>{}}), even_echo(sonar), receiver, setting_of(seed));
    const auto x = pixels_apart(received.power, 4, 2);
    all.insert(all.end(), x.begin(), x.end());
  }
  const auto n = static_cast<double>(all.size());
  ASSERT_GT(n, 250000);
  // Variance of the moment ratio of n exponentials: 4 / n (delta method: 20 - 32 + 16).
  EXPECT_NEAR(moment_ratio(all), 2.0, 0.02);
  EXPECT_LT(ks_distance(all, [](double i) { return 1.0 - std::exp(-i); }), ks_critical(n));

  // Chi-square of the Rayleigh amplitude in 20 classes of equal probability: critical value of 18 degrees at 0.001.
  std::vector<double> counts(20, 0.0);
  for (const double i : all) ++counts[static_cast<std::size_t>(20.0 * (1.0 - std::exp(-i)))];
  double chi_square = 0;
  for (const double c : counts) chi_square += (c - n / 20) * (c - n / 20) / (n / 20);
  EXPECT_LT(chi_square, 42.3);
}

// The point spread keeps the mean power that the clean image has: all its weights are the squares.
TEST(CoherentSpeckle, KeepsTheMeanPowerOfTheCleanImage) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  Echo echo = even_echo(sonar);
  for (int bin = 0; bin < 512; ++bin) {
    for (int b = 0; b < 256; ++b)
      echo.direct(bin, b) *= static_cast<float>(1.0 + std::sin(0.05 * bin) * std::cos(0.1 * b));
  }
  const Image2<float> clean = receiver.spread.apply(echo.direct);
  Image2<double> mean(512, 256);
  constexpr int pings = 60;
  for (std::uint64_t seed = 0; seed < pings; ++seed) {
    const auto received = disturb_echo(chain_of({CoherentSpeckle<double>{}}), echo, receiver, setting_of(seed));
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean.pixels()[i] += static_cast<double>(received.power.pixels()[i]) / pings;
    }
  }
  // 32 x 32 pixels hold some 500 independent ones: 60 pings of them err by 1 / sqrt(30000) = 0.6 %. Sidelobes of Hann
  // hold 0.1 %.
  for (int bin = 32; bin + 32 <= 480; bin += 32) {
    for (int b = 32; b + 32 <= 224; b += 32) {
      double measured = 0, expected = 0;
      for (int i = 0; i < 32; ++i) {
        for (int j = 0; j < 32; ++j) {
          measured += mean(bin + i, b + j);
          expected += static_cast<double>(clean(bin + i, b + j));
        }
      }
      EXPECT_NEAR(measured / expected, 1.0, 0.035) << bin << " " << b;
    }
  }
}

// White along range, two beams a resolution cell across: the recorded pings have .04 to .07 and .51 to .55 / .10 to
// .12.
TEST(CoherentSpeckle, IsCorrelatedAsTheArrayIs) {
  const SonarModel sonar = instrument();
  const auto power =
      disturb_echo(chain_of({CoherentSpeckle<double>{}}), even_echo(sonar), Receiver(sonar), setting_of(2024)).power;
  const auto lag = [&](int bins, int beams) {
    std::vector<double> a, b;
    for (int bin = 4; bin + bins < power.rows() - 4; ++bin) {
      for (int beam = 10; beam + beams < power.columns() - 10; ++beam) {
        a.push_back(static_cast<double>(power(bin, beam)));
        b.push_back(static_cast<double>(power(bin + bins, beam + beams)));
      }
    }
    return correlation_of(a, b);
  };
  // Intensity correlation = |sum of a(k) a(k + lag)|^2 / (sum of a^2)^2 of the array's amplitudes a.
  const auto expected = [&](int beams) {
    const double step = std::sin(sonar.geometry.beam_azimuth_rad[100]) - std::sin(sonar.geometry.beam_azimuth_rad[101]);
    double product = 0, square = 0;
    for (int k = -40; k <= 40; ++k) {
      product += sonar.receive_azimuth.amplitude(k * step) * sonar.receive_azimuth.amplitude((k + beams) * step);
      square += std::pow(sonar.receive_azimuth.amplitude(k * step), 2);
    }
    return std::pow(product / square, 2);
  };
  for (const int beams : {1, 2, 3}) EXPECT_NEAR(lag(0, beams), expected(beams), 0.02) << beams;
  EXPECT_NEAR(lag(1, 0), 0.0, 0.02);
  EXPECT_NEAR(lag(2, 0), 0.0, 0.04);  // the pulse's halves of opposite sign leave (0.16)^2 = 0.03
}

// K: a gamma texture of shape nu that is constant over the resolution cell: <I^2>/<I>^2 = 2 (1 + 1 / nu).
TEST(Texture, MakesClutterKDistributed) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  for (const double nu : {1.0, 3.0, 10.0}) {
    std::vector<double> all;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
      // Patches of 20 cm: some 70 x 14 resolution cells each, a hundred a ping.
      const auto received = disturb_echo(chain_of({Texture<double>{nu, 0.2}, CoherentSpeckle<double>{}}),
                                         even_echo(sonar), receiver, setting_of(seed));
      for (int bin = 4; bin < 508; bin += 4) {
        for (int b = 10; b < 246; b += 5) all.push_back(static_cast<double>(received.power(bin, b)));
      }
    }
    // A hundred patches a ping: 12000 in all. The ratio of the texture then errs by about
    // sqrt(var(T^2) / 12000): 2 % at nu = 1.
    EXPECT_NEAR(moment_ratio(all) / (2.0 * (1.0 + 1.0 / nu)), 1.0, 0.06) << nu;
  }
}

// The incoherent models at equal geometry: independent pixels of a known law.
TEST(IncoherentSpeckle, FollowsItsLaw) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  const auto pixels = [&](const NoiseStage<double>& stage) {
    return pixels_apart(disturb_echo(chain_of({stage}), even_echo(sonar), receiver, setting_of(2024)).power, 1);
  };
  const auto rayleigh = pixels(RayleighSpeckle<double>{});
  const double critical = ks_critical(static_cast<double>(rayleigh.size()));
  EXPECT_LT(ks_distance(rayleigh, [](double i) { return 1.0 - std::exp(-i); }), critical);
  for (const double looks : {0.5, 1.0, 4.0, 30.0}) {
    const auto gamma = pixels(GammaSpeckle<double>{looks});
    EXPECT_LT(ks_distance(gamma, [&](double i) { return gamma_cdf(looks, looks * i); }), critical) << looks;
  }
  for (const double nu : {1.0, 4.0}) {
    EXPECT_NEAR(moment_ratio(pixels(KSpeckle<double>{nu})) / (2.0 * (1.0 + 1.0 / nu)), 1.0, 0.05) << nu;
  }
}

// Scatterers stay where they are: the same pose gives the same speckle, in any ping; another seed gives other.
TEST(CoherentSpeckle, BelongsToTheSurface) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  const NoiseChain chain = chain_of({CoherentSpeckle<double>{}});
  PingSetting again = setting_of(1);
  again.ping = RandomKey::from_seed(99);
  const auto first = disturb_echo(chain, even_echo(sonar), receiver, setting_of(1)).power;
  EXPECT_EQ(first, disturb_echo(chain, even_echo(sonar), receiver, again).power);
  EXPECT_NE(first, disturb_echo(chain, even_echo(sonar), receiver, setting_of(2)).power);
}

// Receiver noise is new in every ping: rho of two pings below 4 / sqrt(n) of n independent pixels.
TEST(ReceiverNoise, IsIndependentFromPingToPing) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  const NoiseChain chain = chain_of({ReceiverNoise<double>{-30, -60}});
  Echo nothing = even_echo(sonar);
  std::fill(nothing.direct.pixels().begin(), nothing.direct.pixels().end(), 0.0F);
  PingSetting again = setting_of(1);
  again.ping = RandomKey::from_seed(99);
  const auto a = pixels_apart(disturb_echo(chain, nothing, receiver, setting_of(1)).power, 4);
  const auto b = pixels_apart(disturb_echo(chain, nothing, receiver, again).power, 4);
  EXPECT_LT(std::abs(correlation_of(a, b)), 4.0 / std::sqrt(static_cast<double>(a.size())));
}

// A stage that is taken away leaves the others' numbers as they are: fields add.
TEST(DisturbEcho, StagesAreSeparable) {
  const SonarModel sonar = instrument();
  const Receiver receiver(sonar);
  Echo nothing = even_echo(sonar);
  std::fill(nothing.direct.pixels().begin(), nothing.direct.pixels().end(), 0.0F);
  const auto noise = ReceiverNoise<double>{-30, -60};
  const auto water = VolumeReverberation<double>{-150};
  const auto alone = disturb_echo(chain_of({noise}), nothing, receiver, setting_of(5)).power;
  const auto beside = disturb_echo(chain_of({water, noise}), nothing, receiver, setting_of(5)).power;
  for (std::size_t i = 0; i < alone.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(beside.pixels()[i]), static_cast<double>(alone.pixels()[i]),
                1e-3 * static_cast<double>(alone.pixels()[i]) + 1e-13);
  }
}

}  // namespace
}  // namespace ensonify
