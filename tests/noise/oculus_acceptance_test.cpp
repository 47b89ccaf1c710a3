// Simulated pings of an Oculus at 2.1 MHz in a rough tank, as the recorded ones: 256 beams, 703 bins, 2 m; profile
// oculus_tank. Every band of acceptance.json (../shared/real/oculus_m1200d_2100khz, from three real pings) must hold
// the 99.9 % confidence interval of the mean over 20 seeds: mean +- 3.88 s / sqrt(20) (Student, 19 degrees, alpha =
// 0.001).
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "ensonify/generators/form_images.hpp"
#include "ensonify/generators/speckle_figures.hpp"
#include "support/test_folders.hpp"

namespace ensonify {
namespace {

constexpr int seeds = 20;
constexpr Region diffuse{300, 460, 20, 240};  // the bed of broken rock
constexpr Region bright{300, 400, 60, 200};
constexpr Region water{70, 170, 60, 200};

GreyImage grey(const SonarImage& image) {
  GreyImage result{Image2<float>(image.grey.rows(), image.grey.columns()), GreyDepth::bits8};
  for (std::size_t i = 0; i < image.grey.size(); ++i)
    result.grey.pixels()[i] = static_cast<float>(image.grey.pixels()[i]);
  return result;
}

double share(const SonarImage& image, int low, int high) {
  double count = 0;
  for (const int v : image.grey.pixels()) count += v >= low && v <= high;
  return count / static_cast<double>(image.grey.size());
}

/// Figures by name, a value a seed.
std::map<std::string, std::vector<double>> figures_of_all_seeds() {
  const Scene scene = load_scene((source_folder() / "reproduction/library/rough_tank.yaml").string());
  const RayScene rays(scene);
  const SonarModel sonar = load_sonar("oculus_m1200d_hf_256");
  const Receiver receiver(sonar);
  const Pose T_world_sonar = pose_from_xyz_rpy({0.9, 0.3, -0.55}, 0.0, radians(38.0), radians(10.0));
  const NoiseProfile profile = load_noise("oculus_tank");
  const PingTracer tracer(rays, sonar, scene.water);
  const Ping ping = tracer.trace(T_world_sonar, {.elevation = true, .multipath_order = 2});
  std::map<std::string, std::vector<double>> figures;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const RandomKey key = RandomKey::from_seed(seed);
    SampledValues sampled;
    const ImageSettings settings{sample_noise(profile, key.child("noise parameters"), sampled), 0.0, 8};
    const auto shot = [&](std::uint64_t number) {
      return form_images(receiver, ping, settings,
                         {T_world_sonar, key.child("surface"), key.child("device"), key.child("noise").child(number)})
          .raw;
    };
    const SonarImage first = shot(1);
    const SonarImage second = shot(2);
    const SpeckleFigures speckle = speckle_figures(grey(first), diffuse, key);
    const auto between_pings = [&](const Region& region) {
      return correlation(normalised_speckle(grey(first), region, key), normalised_speckle(grey(second), region, key));
    };
    figures["weibull_shape"].push_back(speckle.fits.weibull_shape);
    figures["weibull_ks"].push_back(speckle.fits.ks.weibull);
    figures["amp_domain_moment_ratio"].push_back(speckle.moment_ratio);
    figures["acf_beam_lag1"].push_back(speckle.beam[1]);
    figures["acf_beam_lag2"].push_back(speckle.beam[2]);
    figures["acf_range_lag1"].push_back(speckle.range[1]);
    figures["interping_corr_high_snr"].push_back(between_pings(bright));
    figures["interping_corr_noise"].push_back(between_pings(water));
    figures["zero_share"].push_back(share(first, 0, 0));
    figures["saturated_share"].push_back(share(first, 254, 255));
  }
  return figures;
}

struct Band {
  const char* id;
  double low, high;
  double real;  ///< of the recorded pings, for the printed table (far_reverb; bright_reverb for ping to ping)
};

TEST(OculusAcceptance, SimulatedPingsLieInTheBandsOfRealOnes) {
  const std::vector<Band> bands{{"weibull_shape", 3.6, 4.1, 3.91},
                                {"weibull_ks", 0.0, 0.03, 0.013},
                                {"amp_domain_moment_ratio", 1.95, 2.2, 2.01},
                                {"acf_beam_lag1", 0.45, 0.65, 0.55},
                                {"acf_beam_lag2", 0.05, 0.3, 0.12},
                                {"acf_range_lag1", -1.0, 0.25, 0.065},
                                {"interping_corr_high_snr", 0.9, 1.0, 0.984},
                                {"interping_corr_noise", -0.05, 0.05, 0.004},
                                {"zero_share", 0.0, 0.01, 0.0002},
                                {"saturated_share", 0.0, 0.02, 0.008}};
  const auto figures = figures_of_all_seeds();
  std::printf("%-26s %8s +- %-8s  real     band\n", "20 seeds", "mean", "99.9 %");
  for (const Band& band : bands) {
    const std::vector<double>& x = figures.at(band.id);
    double mean = 0, square = 0;
    for (const double v : x) mean += v / seeds;
    for (const double v : x) square += (v - mean) * (v - mean) / (seeds - 1);
    const double half = 3.883 * std::sqrt(square / seeds);
    std::printf("%-26s %8.4f +- %-8.4f  %-8.4f %g to %g\n", band.id, mean, half, band.real, band.low, band.high);
    EXPECT_GE(mean - (band.low > 0.0 ? half : 0.0), band.low) << band.id;
    EXPECT_LE(mean + half, band.high) << band.id;
  }
}

}  // namespace
}  // namespace ensonify
