#include "ensonify/generators/speckle_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ensonify/generators/acceptance_bands.hpp"
#include "ensonify/generators/against.hpp"
#include "ensonify/generators/gamma_function.hpp"
#include "ensonify/generators/level_figures.hpp"
#include "ensonify/generators/ping_series.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

const RandomKey key = RandomKey::from_seed(11);

std::vector<double> weibull_sample(double shape, double scale, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    values.push_back(scale * std::pow(-std::log(uniform_at(key, static_cast<std::uint64_t>(i))), 1 / shape));
  }
  return values;
}

// Values of Abramowitz and Stegun, tables 6.1 and 6.3, and closed forms.
TEST(GammaFunction, TakesKnownValues) {
  EXPECT_NEAR(digamma(1), -0.57721566490153286, 1e-12);
  EXPECT_NEAR(digamma(0.5), -1.96351002602142348, 1e-12);
  EXPECT_NEAR(digamma(30) - digamma(29), 1.0 / 29, 1e-12);
  EXPECT_NEAR(log_gamma(5), std::log(24.0), 1e-12);
  for (const double x : {0.01, 0.5, 1.9, 2.1, 7.0, 40.0}) {
    EXPECT_NEAR(gamma_distribution(1, x), -std::expm1(-x), 1e-12) << x;
    EXPECT_NEAR(gamma_distribution(0.5, x), std::erf(std::sqrt(x)), 1e-12) << x;
    EXPECT_NEAR(gamma_distribution(3, x), 1 - std::exp(-x) * (1 + x + x * x / 2), 1e-12) << x;
  }
  EXPECT_EQ(gamma_distribution(2, 0), 0);
  EXPECT_NEAR(gamma_distribution(1000, 1000), 0.5042, 1e-4);  // 1/2 + 1 / (3 sqrt(2 pi a))
}

// The deviation of the shape's estimate is 0.78 shape / sqrt(n) (Johnson, Kotz, Balakrishnan 1994, 21): four of them.
TEST(AmplitudeFits, FindTheWeibullLawOfASample) {
  constexpr int n = 20000;
  for (const double shape : {0.7, 2.0, 3.9, 9.0}) {
    const AmplitudeFits fits = fit_amplitudes(weibull_sample(shape, 1.7, n));
    EXPECT_NEAR(fits.weibull_shape, shape, 4 * 0.78 * shape / std::sqrt(n)) << shape;
    EXPECT_NEAR(fits.weibull_scale, 1.7, 4 * 1.05 * 1.7 / shape / std::sqrt(n)) << shape;
    EXPECT_LT(fits.ks.weibull, 0.012) << shape;
  }
}

// Of the Weibull family, shape 2 is Rayleigh's law and shape 1 the exponential one; Nakagami and gamma hold them too.
TEST(AmplitudeFits, AgreeWhereLawsAreOne) {
  const AmplitudeFits rayleigh = fit_amplitudes(weibull_sample(2, 1, 20000));
  EXPECT_LT(std::max({rayleigh.ks.rayleigh, rayleigh.ks.nakagami, rayleigh.ks.k, rayleigh.ks.weibull}), 0.012);
  EXPECT_NEAR(rayleigh.nakagami_shape, 1, 0.03);
  EXPECT_GT(rayleigh.k_shape, 20);
  EXPECT_GT(rayleigh.ks.exponential, 0.1);
  const AmplitudeFits exponential = fit_amplitudes(weibull_sample(1, 1, 20000));
  EXPECT_LT(std::max({exponential.ks.exponential, exponential.ks.gamma}), 0.012);
  EXPECT_NEAR(exponential.gamma_shape, 1, 0.03);
  EXPECT_GT(exponential.ks.lognormal, 0.05);
}

// K: Rayleigh's amplitude times the root of a gamma variable of mean 1; of shape 3, a sum of three exponential ones.
TEST(AmplitudeFits, FindTheKLawOfASample) {
  RandomSequence random(key.child("k"));
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    const double texture = -std::log(random.uniform() * random.uniform() * random.uniform()) / 3;
    values.push_back(std::sqrt(-texture * std::log(random.uniform())));
  }
  const AmplitudeFits fits = fit_amplitudes(values);
  EXPECT_NEAR(fits.k_shape, 3, 0.5);
  EXPECT_LT(fits.ks.k, 0.015);
  EXPECT_GT(fits.ks.rayleigh, 0.03);
}

GreyImage image_of(int rows, int columns, const auto& level) {
  GreyImage image{Image2<float>(rows, columns), 1};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) image.levels(r, c) = static_cast<float>(level(r, c));
  }
  return image;
}

// Means mirrored at the border, pixel by pixel by their definition.
TEST(NormalisedSpeckle, IsThePixelOverItsMirroredMean) {
  const GreyImage image = image_of(40, 70, [](int r, int c) { return 30 + (r * 37 + c * 101 + r * c) % 90; });
  const Region region{5, 24, 10, 65};  // 19 rows: fewer than the window
  const Image2<double> normalised = normalised_speckle(image, region, key);
  ASSERT_EQ(normalised.rows(), 19);
  ASSERT_EQ(normalised.columns(), 55);
  const auto mirrored = [](int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; };
  for (const auto& [r, c] : {std::pair{0, 0}, {18, 54}, {9, 27}, {3, 50}}) {
    double sum = 0;
    for (int i = -12; i <= 12; ++i) {
      for (int j = -12; j <= 12; ++j) sum += image.levels(5 + mirrored(r + i, 19), 10 + mirrored(c + j, 55));
    }
    EXPECT_NEAR(normalised(r, c), image.levels(5 + r, 10 + c) / (sum / 625), 0.55 / (sum / 625)) << r << " " << c;
  }
}

TEST(NormalisedSpeckle, OfEmptyWaterIsJitter) {
  const GreyImage image = image_of(64, 64, [](int, int) { return 0; });
  const auto normalised = normalised_speckle(image, {0, 64, 0, 64}, key);
  for (const double v : normalised.pixels()) EXPECT_TRUE(v > 0 && std::isfinite(v));
  EXPECT_NEAR(correlation(normalised, normalised_speckle(image, {0, 64, 0, 64}, key.child(1))), 0, 0.06);
  EXPECT_EQ(normalised, normalised_speckle(image, {0, 64, 0, 64}, key));
}

TEST(Autocorrelation, TellsRangeFromBeams) {
  Image2<double> stripes(64, 64);
  for (int r = 0; r < 64; ++r) {
    for (int c = 0; c < 64; ++c) stripes(r, c) = c % 4 < 2 ? 1 : -1;
  }
  const Autocorrelation range = range_autocorrelation(stripes), beam = beam_autocorrelation(stripes);
  for (const double v : range) EXPECT_NEAR(v, 1, 1e-12);
  EXPECT_NEAR(beam[2], -1, 1e-12);
  EXPECT_NEAR(beam[4], 1, 1e-12);
  EXPECT_NEAR(beam[1], 0, 0.02);
}

/// Fully developed speckle at gamma 0.5: white circular complex Gauss cells, smeared before detection by a Gaussian of
/// sigma 1 beam and 0.4 range bin.
GreyImage gaussian_speckle(int rows, int columns, RandomKey cells) {
  constexpr int reach = 5;
  const auto kernel = [](double d, double sigma) { return std::exp(-d * d / (2 * sigma * sigma)); };
  const int wide = columns + 2 * reach;
  const auto cell = [&](int r, int c) {
    const auto at = 2 * (static_cast<std::uint64_t>(r) * wide + c);
    return std::complex<double>(normal_at(cells, at), normal_at(cells, at + 1));
  };
  Image2<std::complex<double>> white(rows + 2 * reach, wide);
  for (int r = 0; r < white.rows(); ++r) {
    for (int c = 0; c < wide; ++c) white(r, c) = cell(r, c);
  }
  return image_of(rows, columns, [&](int r, int c) {
    std::complex<double> sum = 0;
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        sum += kernel(i, 0.4) * kernel(j, 1.0) * white(r + reach + i, c + reach + j);
      }
    }
    return std::min(255.0, std::round(40 * std::sqrt(std::abs(sum))));
  });
}

// The field's correlation at lag l is exp(-l^2 / (4 sigma^2)), and the root of the amplitude correlates nearly as the
// intensity does: by its square, 0.61 and 0.14 for 1 and 2 beams; the local mean and the root take some of it. Recorded
// for 400 x 256 such cells: shape 3.96, KS 0.008, moment ratio 1.96, beams 0.53 0.11 0.00, range 0.
TEST(SpeckleFigures, OfFullyDevelopedSpeckle) {
  const GreyImage image = gaussian_speckle(400, 256, key.child("cells"));
  const SpeckleFigures f = speckle_figures(image, {0, 400, 0, 256}, key);
  EXPECT_NEAR(f.fits.weibull_shape, 3.96, 0.1);
  EXPECT_LT(f.fits.ks.weibull, 0.016);
  EXPECT_NEAR(f.moment_ratio, 1.97, 0.07);
  EXPECT_NEAR(f.beam[1], 0.54, 0.04);
  EXPECT_NEAR(f.beam[2], 0.11, 0.03);
  EXPECT_NEAR(f.beam[3], 0.0, 0.03);
  EXPECT_NEAR(f.range[1], 0.0, 0.03);
  EXPECT_NEAR(f.contrast, 0.28, 0.02);
  EXPECT_GT(f.fits.ks.rayleigh, 0.15);

  // A tile holds 2048 pixels and mirrors its border, and still says what a large area does.
  std::vector<SpeckleFigures> tiles;
  for (const Tile& tile : all_tiles(image)) tiles.push_back(speckle_figures(image, tile.region, key));
  const SpeckleFigures median = median_figures(tiles);
  std::printf(
      "whole: shape %.3f ks %.4f ratio %.3f beam %.3f %.3f range %.3f; tiles: shape %.3f ks %.4f ratio %.3f beam "
      "%.3f %.3f range %.3f\n",
      f.fits.weibull_shape, f.fits.ks.weibull, f.moment_ratio, f.beam[1], f.beam[2], f.range[1],
      median.fits.weibull_shape, median.fits.ks.weibull, median.moment_ratio, median.beam[1], median.beam[2],
      median.range[1]);
  EXPECT_NEAR(median.fits.weibull_shape, f.fits.weibull_shape, 0.1);
  EXPECT_NEAR(median.moment_ratio, f.moment_ratio, 0.05);
  EXPECT_NEAR(median.beam[1], f.beam[1], 0.02);
  EXPECT_LT(median.fits.ks.weibull, 0.03);
}

/// Folder of the real pings (shared/real), empty where it is absent.
fs::path real_pings() {
  const char* shared = std::getenv("ENSONIFY_SHARED");
  const fs::path root =
      shared != nullptr ? fs::path(shared) : fs::path(std::getenv("ENSONIFY_SOURCE_DIR")) / "../shared";
  const fs::path folder = root / "real/oculus_m1200d_2100khz";
  return fs::is_regular_file(folder / "stats.json") ? folder : fs::path();
}

class RealPings : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path folder = real_pings();
    if (folder.empty()) GTEST_SKIP() << "no real pings; set ENSONIFY_SHARED to the folder that holds real/";
    pings = open_pings(folder, "test");
    stats = nlohmann::json::parse(std::ifstream(folder / "stats.json")).at("oculus_m1200d_2100khz");
  }

  PingSeries pings;
  nlohmann::json stats;
  const std::vector<std::pair<std::string, Region>> regions{{"water_column_quiet", {70, 170, 60, 200}},
                                                            {"near_field_0_60bins", {0, 60, 0, 256}},
                                                            {"bright_reverb", {290, 400, 20, 240}},
                                                            {"far_reverb", {560, 700, 20, 240}},
                                                            {"shadowed_mid", {430, 500, 170, 240}}};
};

// Jitter and draw are other random numbers than those of the recorded figures, which are of one draw. Where the echo is
// stationary, that hardly matters. Elsewhere a few pixels of the tails decide (bright_reverb's moment ratio is 2.1 or
// 3.1), so the recorded figure has to be within what a hundred draws give.
TEST_F(RealPings, HaveTheRecordedSpeckle) {
  const GreyImage first = read_ping(pings, 0), second = read_ping(pings, 1);
  for (const auto& [name, region] : regions) {
    SCOPED_TRACE(name);
    const auto& recorded = stats.at("regions").at(name);
    const auto& fit = recorded.at("amp_fit");
    const auto& ks = fit.at("ks");
    const auto& params = fit.at("params");
    std::vector<SpeckleFigures> draws;
    for (std::uint64_t i = 0; i < 100; ++i) {
      draws.push_back(speckle_figures(first, region, key.child(i)));
    }
    const auto check = [&](const char* what, const nlohmann::json& value, double tolerance, const auto& figure) {
      double low = figure(draws[0]), high = low;
      for (const SpeckleFigures& f : draws) {
        low = std::min(low, figure(f));
        high = std::max(high, figure(f));
      }
      EXPECT_GE(value.get<double>(), low - tolerance) << what;
      EXPECT_LE(value.get<double>(), high + tolerance) << what;
      std::printf("%-20s %-14s recorded %8.4f here %8.4f (%.4f to %.4f)\n", name.c_str(), what, value.get<double>(),
                  figure(draws[0]), low, high);
    };
    using F = const SpeckleFigures&;
    check("mean level", recorded.at("mean_level"), 1e-6, [](F f) { return f.mean_level; });
    check("zero share", recorded.at("zero_share"), 1e-9, [](F f) { return f.zero_share; });
    check("contrast", fit.at("contrast_std_over_mean"), 0.005, [](F f) { return f.contrast; });
    check("Weibull shape", params.at("weibull")[0], 0.05, [](F f) { return f.fits.weibull_shape; });
    check("Weibull scale", params.at("weibull")[2], 0.005, [](F f) { return f.fits.weibull_scale; });
    check("gamma shape", params.at("gamma")[0], 0.35, [](F f) { return f.fits.gamma_shape; });
    check("Nakagami shape", params.at("nakagami")[0], 0.1, [](F f) { return f.fits.nakagami_shape; });
    check("lognormal", params.at("lognormal")[0], 0.03, [](F f) { return f.fits.lognormal_sigma; });
    check("KS Weibull", ks.at("weibull"), 0.006, [](F f) { return f.fits.ks.weibull; });
    check("KS Rayleigh", ks.at("rayleigh"), 0.006, [](F f) { return f.fits.ks.rayleigh; });
    check("KS exponential", ks.at("exponential"), 0.006, [](F f) { return f.fits.ks.exponential; });
    check("KS gamma", ks.at("gamma"), 0.006, [](F f) { return f.fits.ks.gamma; });
    check("KS lognormal", ks.at("lognormal"), 0.008, [](F f) { return f.fits.ks.lognormal; });
    check("KS Nakagami", ks.at("nakagami"), 0.006, [](F f) { return f.fits.ks.nakagami; });
    check("KS K", ks.at("k"), 0.006, [](F f) { return f.fits.ks.k; });
    check("moment ratio", fit.at("amp_domain_intensity_moment_ratio(2=fully developed)"), 0.05,
          [](F f) { return f.moment_ratio; });
    if (name == "far_reverb" || name == "shadowed_mid") {
      EXPECT_NEAR(draws[0].fits.weibull_shape, params.at("weibull")[0].get<double>(), 0.05);
      EXPECT_NEAR(draws[0].fits.ks.weibull, ks.at("weibull").get<double>(), 0.006);
      EXPECT_NEAR(draws[0].moment_ratio, fit.at("amp_domain_intensity_moment_ratio(2=fully developed)").get<double>(),
                  0.05);
    }
    for (std::size_t lag = 0; lag <= most_lag; ++lag) {
      EXPECT_NEAR(draws[0].range[lag], recorded.at("acf_range")[lag].get<double>(), 0.004) << lag;
      EXPECT_NEAR(draws[0].beam[lag], recorded.at("acf_beam")[lag].get<double>(), 0.004) << lag;
    }
    const double between =
        correlation(normalised_speckle(first, region, key.child(0)), normalised_speckle(second, region, key.child(1)));
    EXPECT_NEAR(between, stats.at("interping_corr").at(name).get<double>(), 0.02);
    std::printf("%-20s beam %.3f %.3f range %.3f %.3f ping to ping %.3f\n", name.c_str(), draws[0].beam[1],
                draws[0].beam[2], draws[0].range[1], draws[0].range[2], between);
  }
}

TEST_F(RealPings, HaveTheRecordedLevels) {
  LevelSums sums;
  for (int i = 0; i < pings.count(); ++i) sums += sum_levels(read_ping(pings, i));
  const auto& global = stats.at("global");
  EXPECT_EQ(sums.pixels, global.at("n_px").get<std::uint64_t>());
  EXPECT_NEAR(sums.mean(), global.at("mean").get<double>(), 1e-9);
  EXPECT_NEAR(sums.standard_deviation(), global.at("std").get<double>(), 1e-9);
  const auto n = static_cast<double>(sums.pixels);
  EXPECT_NEAR(static_cast<double>(sums.zeros) / n, global.at("zero_share").get<double>(), 1e-12);
  EXPECT_NEAR(static_cast<double>(sums.saturated) / n, global.at("saturated_ge254_share").get<double>(), 1e-12);
  for (std::size_t i = 0; i < level_percents.size(); ++i) {
    EXPECT_EQ(sums.percentile(level_percents[i]), global.at("pct_1_5_25_50_75_90_95_99_999")[i].get<double>());
  }
  for (std::size_t i = 0; i < sums.range_sum.size(); ++i) {
    EXPECT_NEAR(sums.range_sum[i] / static_cast<double>(sums.range_pixels[i]),
                stats.at("range_profile_20bins")[i].get<double>(), 0.006)
        << i;
  }
}

// The bands of acceptance.json were taken from these pings: tiles found in them by rule must lie inside.
TEST_F(RealPings, LieWithinTheirBandsInTheTilesFound) {
  const SideFigures side = describe_side(pings, {}, [](int, int) {});
  EXPECT_GE(side.tiles.size(), 30U);
  const std::vector<AcceptanceBand> bands = read_acceptance_bands(pings.folder);
  EXPECT_EQ(bands.size(), 10U);
  for (const AcceptanceBand& band : bands) {
    std::printf("%-26s %.4f\n", band.id.c_str(), band_value(side, band.id).value());
    if (band.id == noise_band) continue;
    EXPECT_EQ(inside(band, side), true) << band.id;
  }
  // Not 0 as in the quiet water: the darkest quarter of the tiles holds some echo.
  EXPECT_LT(side.ping_to_ping.dark.value(), 0.25);
}

}  // namespace
}  // namespace ensonify
