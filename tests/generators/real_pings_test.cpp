#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ensonify/generators/acceptance_bands.hpp"
#include "ensonify/generators/against.hpp"
#include "support/test_folders.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

const RandomKey key = RandomKey::from_seed(11);

/// Folder of the real pings (shared/real), empty where it is absent.
fs::path real_pings() {
  const fs::path folder = shared_folder() / "real/oculus_m1200d_2100khz";
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
    const auto check = [&, &name = name](const char* what, const nlohmann::json& value, double tolerance,
                                         const auto& figure) {
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
