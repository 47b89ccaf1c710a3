// Every device artefact against what its words say. Powers are over full scale: echo times the receive chain's gain.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/noise/disturb_echo.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"
#include "support/pings.hpp"
#include "support/statistics.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr int bins = 400;
constexpr int beams = 256;

SonarModel instrument() {
  SonarModel sonar = bare_sonar({.range_min_m = 1.0, .range_max_m = 5.0, .bins = bins});
  sonar.geometry.beam_azimuth_rad = uniform_sine_beams(beams, radians(60.0));
  sonar.receive = {40.0, 0.0, 175.0, 0.5, 8};
  return sonar;
}

ReceivedEcho received_by(const SonarModel& sonar, std::vector<NoiseStage<double>> stages, const Echo& echo,
                         std::uint64_t ping = 1, double absorption_db_per_m = 0) {
  const RandomKey key = RandomKey::from_seed(7);
  return disturb_echo(
      {"test", std::move(stages)}, echo, Receiver(sonar),
      {Pose::Identity(), key.child("surface"), key.child("device"), key.child(ping), absorption_db_per_m});
}

ReceivedEcho received(std::vector<NoiseStage<double>> stages, const Echo& echo, std::uint64_t ping = 1) {
  return received_by(instrument(), std::move(stages), echo, ping);
}

Echo silence() { return {Image2<float>(bins, beams), {}, {}}; }

Echo point(int bin, int beam, float power = 1e-6F) {
  Echo echo = silence();
  echo.direct(bin, beam) = power;
  return echo;
}

double mean_over_full_scale(const Image2<float>& power, int bin0, int bin1) {
  const std::vector<float> gains = row_gains(instrument());
  double sum = 0;
  for (int bin = bin0; bin < bin1; ++bin) {
    for (int b = 16; b < beams - 16; ++b)
      sum += static_cast<double>(power(bin, b) * gains[static_cast<std::size_t>(bin)]);
  }
  return sum / ((bin1 - bin0) * (beams - 32));
}

double db(double x) { return 10.0 * std::log10(x); }

// level_db at the end of the window; TVG 40 log r, so at half that range 12 dB less. 10 rows hold 1100 independent
// pixels: 0.13 dB.
TEST(ReceiverNoise, FollowsTheTvgAndHasAFloor) {
  const auto noise = received({ReceiverNoise<double>{-30, -200}}, silence()).power;
  EXPECT_NEAR(db(mean_over_full_scale(noise, 390, 400)), -30.0, 0.6);
  EXPECT_NEAR(db(mean_over_full_scale(noise, 145, 155)), -30.0 + 40 * std::log10(2.5 / 5.0), 0.6);
  const auto floor = received({ReceiverNoise<double>{-200, -50}}, silence()).power;
  EXPECT_NEAR(db(mean_over_full_scale(floor, 0, 10)), -50.0, 0.6);
  EXPECT_NEAR(db(mean_over_full_scale(floor, 390, 400)), -50.0, 0.6);
}

// The sum of independent noise of all elements is as strong in every direction, however the beams are spaced. Means
// over 400 bins of 4 pings and 9 beams, of which 2 or more are independent: 0.11 dB; bands of 4 sigma.
TEST(ReceiverNoise, IsAsStrongInEveryBeam) {
  for (const bool even_angles : {false, true}) {
    SonarModel sonar = instrument();
    if (even_angles) sonar.geometry.beam_azimuth_rad = uniform_angle_beams(beams, radians(140.0));
    std::vector<double> across(beams, 0.0);
    for (const std::uint64_t ping : {1, 2, 3, 4}) {
      const auto noise = received_by(sonar, {ReceiverNoise<double>{-200, -50}}, silence(), ping).power;
      const std::vector<float> gains = row_gains(sonar);
      for (int i = 0; i < bins; ++i) {
        for (int b = 0; b < beams; ++b) across[b] += static_cast<double>(noise(i, b) * gains[i]) / (4.0 * bins);
      }
    }
    for (int first = 0; first + 9 <= beams; first += 9) {
      double mean = 0;
      for (int b = first; b < first + 9; ++b) mean += across[b] / 9;
      EXPECT_NEAR(db(mean), -50.0, 0.45) << first;
    }
  }
}

// Volume scattering of strength s over the solid angle Omega of a beam's cell: s Omega dr r^-2, through an array of
// noise gain g (Urick 1983, 8.7). The box pattern fills elevation_fov.
TEST(VolumeReverberation, HasTheLevelOfItsStrength) {
  const SonarModel sonar = instrument();
  const auto water = received({VolumeReverberation<double>{-40}}, silence()).power;
  const double cell_rad =
      (sonar.geometry.beam_azimuth_rad.front() - sonar.geometry.beam_azimuth_rad.back()) / (beams - 1);
  const double solid_angle = cell_rad * 2.0 * std::sin(0.5 * sonar.geometry.elevation_fov_rad);
  for (const int bin : {20, 200, 380}) {
    const double r = sonar.geometry.bin_centre_m(bin);
    const double expected = 1e-4 * solid_angle * 0.01 / (r * r) * Receiver(sonar).coherent.noise_gain()[beams / 2];
    double measured = 0;
    for (int i = bin - 5; i < bin + 5; ++i) {
      for (int b = 16; b < beams - 16; ++b) measured += static_cast<double>(water(i, b)) / (10.0 * (beams - 32));
    }
    EXPECT_NEAR(db(measured / expected), 0.0, 0.7) << bin;
  }
}

// Of the water, not of the TVG, comes the loss over range; across beams it follows the cells' widths, 1 / cos(theta)
// for beams even in sin(theta), and the fan's pattern. Means of 40 bins x 9 beams x 8 pings: 0.16 dB.
TEST(VolumeReverberation, IsAbsorbedByTheWaterAndShapedByTheFan) {
  SonarModel sonar = instrument();
  sonar.geometry.beam_azimuth_rad = uniform_sine_beams(beams, radians(120.0));
  sonar.fan_edge_db = 6;
  sonar.receive.tvg_absorption_db_per_m = 3;
  const auto level = [&](int bin0, int beam0) {
    double sum = 0;
    for (std::uint64_t ping = 1; ping <= 8; ++ping) {
      const auto water = received_by(sonar, {VolumeReverberation<double>{-40}}, silence(), ping, 0.7).power;
      for (int i = bin0; i < bin0 + 40; ++i) {
        for (int b = beam0; b < beam0 + 9; ++b) sum += static_cast<double>(water(i, b));
      }
    }
    return db(sum);
  };
  const double far_m = sonar.geometry.bin_start_m(340), near_m = sonar.geometry.bin_start_m(100);
  EXPECT_NEAR(level(320, 124) - level(80, 124), -2 * 0.7 * (far_m - near_m) - 20 * std::log10(far_m / near_m), 0.7);
  const double azimuth = sonar.geometry.beam_azimuth_rad[4];
  EXPECT_NEAR(level(320, 0) - level(320, 124), -db(std::cos(azimuth)) - 6 * std::pow(azimuth / radians(60.4), 2), 0.7);
}

TEST(RingDown, FallsByItsDecayAndIsOfTheDevice) {
  const auto ring = [](std::uint64_t ping) { return received({RingDown<double>{-20, 0.3}}, silence(), ping).power; };
  const auto power = ring(1);
  EXPECT_EQ(power, ring(2));
  double near = 0, far = 0;  // 60 rows of 30 independent beams each: 0.1 dB
  near = mean_over_full_scale(power, 0, 60);
  far = mean_over_full_scale(power, 60, 120);
  EXPECT_NEAR(db(near / far), db(std::exp(0.6 / 0.3)), 1.0);
  EXPECT_NEAR(db(near), -20.0 + db((std::exp(-1.0 / 0.3) - std::exp(-1.6 / 0.3)) * 0.3 / 0.6), 1.0);
}

// A lone target leaks into all beams at its range, and into no other range.
TEST(SidelobeArcs, RingTheFanAtTheRangeOfATarget) {
  const Echo echo = point(200, 60);
  const auto plain = received({RayleighSpeckle<double>{}}, echo);
  const auto arcs = received({RayleighSpeckle<double>{}, SidelobeArcs<double>{-40}}, echo);
  double target = 0;
  for (int b = 0; b < beams; ++b) target += static_cast<double>(plain.power(200, b));
  // Far from the target a beam holds leak * (sum over the fan with the device's phases)^2: within a factor of the
  // phases.
  double least = 1e30, most = 0;
  for (int b = 100; b < beams; ++b) {
    least = std::min(least, static_cast<double>(arcs.power(200, b)));
    most = std::max(most, static_cast<double>(arcs.power(200, b)));
  }
  EXPECT_NEAR(db(most / least), 0.0, 0.01);  // an arc: as strong everywhere
  EXPECT_LT(most, 4e-4 * target);
  EXPECT_GT(least, 1e-6 * target);
  for (int b = 100; b < beams; ++b) ASSERT_EQ(arcs.power(204, b), 0.0F);
  // Labels go by the mean over phases.
  const double mean_target = sum_of(Receiver(instrument()).spread.apply(echo.direct));
  EXPECT_NEAR(static_cast<double>(arcs.sidelobe(200, 200)) / (1e-4 * mean_target), 1.0, 0.01);
}

TEST(CrossTalk, CopiesEveryPeriod) {
  const Echo echo = point(200, 120);
  const auto talk = received({RayleighSpeckle<double>{}, CrossTalk<double>{-20, 16, 6}}, echo).power;
  const auto at = [&](int beam) { return db(static_cast<double>(talk(200, beam) / talk(200, 120))); };
  EXPECT_NEAR(at(136), -20.0, 0.01);
  EXPECT_NEAR(at(104), -20.0, 0.01);
  EXPECT_NEAR(at(152), -26.0, 0.01);
  EXPECT_EQ(talk(200, 112), 0.0F);
  EXPECT_EQ(talk(210, 136), 0.0F);
}

TEST(Interference, HasItsCountLevelAndLength) {
  int struck = 0;
  constexpr int pings = 200;
  for (std::uint64_t ping = 0; ping < pings; ++ping) {
    const auto power = received({Interference<double>{0.5, -10, 0.05}}, silence(), ping).power;
    const std::vector<float> gains = row_gains(instrument());
    int rows = 0;
    for (int bin = 0; bin < bins; ++bin) {
      const auto row = power.row(bin);
      const auto brightest = std::max_element(row.begin(), row.end());
      if (*brightest == 0.0F) continue;
      ++rows;
      EXPECT_NEAR(db(static_cast<double>(*brightest * gains[static_cast<std::size_t>(bin)])), -10.0, 0.01);
      EXPECT_NEAR(db(static_cast<double>(*std::min_element(row.begin(), row.end()) / *brightest)), -26.0, 0.1);
    }
    if (rows > 0) {
      ++struck;
      EXPECT_LE(rows, 5);  // 5 cm are 5 bins; a pulse at the end of the window is cut
    }
  }
  EXPECT_NEAR(struck, 0.5 * pings, 4.0 * std::sqrt(0.25 * pings));  // binomial, 4 sigma
}

// Echo moves away only, by an exponential of the mean asked, and loses exp(-x / sigma): mean left = 1 / 2, at mean 1 /
// 2 sigma (integrals of e^-2x and x e^-2x).
TEST(RangeJitter, MovesEnergyAway) {
  Echo echo = silence();
  for (int b = 0; b < beams; ++b) echo.direct(50, b) = 1e-6F;
  double energy = 0, moved = 0;
  constexpr int pings = 40;
  for (std::uint64_t ping = 0; ping < pings; ++ping) {
    const Echo layers = received({RangeJitter<double>{0.1}}, echo, ping).layers;
    for (int bin = 0; bin < bins; ++bin) {
      for (int b = 0; b < beams; ++b) {
        const double share = static_cast<double>(layers.direct(bin, b)) / 1e-6 / beams / pings;
        ASSERT_TRUE(bin >= 50 || layers.direct(bin, b) == 0.0F);
        energy += share;
        moved += share * (bin - 50) * 0.01;
      }
    }
  }
  EXPECT_NEAR(energy, 0.5, 0.02);
  EXPECT_NEAR(moved / energy, 0.05, 0.003);
}

TEST(Multipath, EntersAtItsLevel) {
  Echo echo = silence();
  echo.multipath = Image2<float>(bins, beams, 1e-7F);
  const auto with = received({Multipath<double>{-6, 2, 1}}, echo);
  EXPECT_NEAR(db(static_cast<double>(with.layers.multipath(9, 9)) / 1e-7), -6.0, 1e-3);
  EXPECT_GT(sum_of(with.power), 0.0);
  EXPECT_EQ(sum_of(received({RayleighSpeckle<double>{}}, echo).power), 0.0);  // without the stage it is not there
}

}  // namespace
}  // namespace ensonify
