#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/scenes/water.hpp"
#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sensor_models/sonar_model.hpp"
#include "support/test_folders.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

/// Written down from the data sheets (docs/instruments.md names them), apart from the YAML.
struct Sheet {
  const char* name;
  double khz;
  int beams;
  double azimuth_fov_deg, elevation_fov_deg, beam_deg, range_max_m;
};

TEST(SonarLoader, BundledSonarsAreThoseOfTheDataSheets) {
  const std::vector<Sheet> sheets{{"aris_explorer_3000", 3000, 128, 30, 15, 0.25, 5},
                                  {"aris_explorer_3000_lf", 1800, 128, 30, 15, 0.4, 15},
                                  {"blueview_p900", 900, 512, 90, 20, 1.0, 60},
                                  {"didson_hf", 1800, 96, 29, 14, 0.3, 12},
                                  {"didson_lf", 1100, 48, 29, 14, 0.6, 35},
                                  {"gemini_720is", 720, 512, 120, 20, 1.0, 120},
                                  {"holoocean", 900, 512, 120, 20, 0.235, 100},
                                  {"oculus_m1200d_hf", 2100, 512, 60, 12, 0.4, 10},
                                  {"oculus_m1200d_hf_256", 2100, 256, 60, 12, 0.4, 10},
                                  {"oculus_m1200d_lf", 1200, 512, 130, 20, 0.6, 40},
                                  {"oculus_m3000d_hf", 3000, 512, 40, 20, 0.25, 5},
                                  {"oculus_m3000d_lf", 1200, 512, 130, 20, 0.6, 30},
                                  {"oculus_m370s", 375, 256, 130, 20, 2.0, 200},
                                  {"oculus_m750d_hf", 1200, 512, 130, 20, 0.6, 40},
                                  {"oculus_m750d_lf", 750, 512, 130, 20, 1.0, 120}};
  std::vector<std::string> names;
  for (const Sheet& sheet : sheets) names.push_back(sheet.name);
  EXPECT_EQ(library_names("sensor_models"), names);
  for (const Sheet& sheet : sheets) {
    const SonarModel sonar = load_sonar(sheet.name);
    const SonarGeometry& g = sonar.geometry;
    EXPECT_EQ(sonar.name, sheet.name);
    EXPECT_NEAR(sonar.frequency_hz, 1e3 * sheet.khz, 1) << sheet.name;
    EXPECT_EQ(g.beams(), sheet.beams) << sheet.name;
    EXPECT_EQ(g.range_bins, sheet.name == std::string("oculus_m1200d_hf_256") ? 703 : 512) << sheet.name;
    EXPECT_NEAR(degrees(g.beam_azimuth_rad.front() - g.beam_azimuth_rad.back()), sheet.azimuth_fov_deg, 1e-9);
    EXPECT_NEAR(degrees(g.elevation_fov_rad), sheet.elevation_fov_deg, 1e-9) << sheet.name;
    EXPECT_NEAR(degrees(sonar.receive_azimuth.width_rad()), sheet.beam_deg, 1e-9) << sheet.name;
    EXPECT_EQ(sonar.instrument_range_max_m, sheet.range_max_m) << sheet.name;
    for (int b = 1; b < g.beams(); ++b) ASSERT_LT(g.beam_azimuth_rad[b], g.beam_azimuth_rad[b - 1]);
    // The TVG undoes what sea water of 10 C absorbs; only HoloOcean's has nothing to undo but our own echo.
    EXPECT_NEAR(sonar.receive.tvg_absorption_db_per_m, absorption_db_per_m({10, 35, 5, 8}, sonar.frequency_hz),
                std::string(sheet.name).starts_with("oculus_m1200d_hf") ? 0.03 : 0.01)
        << sheet.name;
    EXPECT_GE(sonar.native_bin_m, 0.9 * 1490 / (2 * sonar.bandwidth_hz)) << sheet.name << ": finer than its pulse";
  }
}

// c / (2 B) = 1490 / (2 * 262e3) = 2.843 mm: native bins of 2.842 mm, floor((5 - 0.1) / 0.002842) = 1724 of them.
TEST(SonarLoader, NativeBins) {
  const SonarModel sonar = load_sonar("oculus_m1200d_hf", {.range_min_m = 0.1, .range_max_m = 5.0, .range_bins = 0});
  EXPECT_EQ(sonar.geometry.range_bins, 1724);
  EXPECT_NEAR(sonar.geometry.bin_size_m(), 0.002842, 1e-12);
  EXPECT_NEAR(sonar.geometry.range_max_m, 0.1 + 1724 * 0.002842, 1e-9);
  EXPECT_NEAR(1490.0 / (2.0 * sonar.bandwidth_hz), sonar.native_bin_m, 5e-6);
}

// Measured on a real Oculus at 2.1 MHz: 256 beams, +-30 deg, spacing 0.225 deg in the middle and 0.26 at the edge.
TEST(BeamTable, UniformSineIsTheOculusLaw) {
  const auto azimuth = uniform_sine_beams(256, radians(60.0));
  EXPECT_NEAR(degrees(azimuth.front()), 30.0, 1e-9);
  EXPECT_NEAR(degrees(azimuth.back()), -30.0, 1e-9);
  EXPECT_NEAR(degrees(azimuth[127] - azimuth[128]), 0.225, 0.0005);
  EXPECT_NEAR(degrees(azimuth[0] - azimuth[1]), 0.26, 0.002);
  for (int b = 0; b < 256; ++b) {
    EXPECT_NEAR(azimuth[b], std::asin(0.5 - b / 255.0), 1e-12);
    EXPECT_NEAR(azimuth[b], -azimuth[255 - b], 1e-12);
  }
}

// The header of a raw ping holds the bearings as 256 little-endian int16 in 0.01 deg, from byte 122 on.
TEST(BeamTable, RealOculusHeader) {
  const fs::path file = shared_folder() / "real/oculus_m1200d_2100khz/one_ping_8bit.raw";
  if (!fs::is_regular_file(file)) GTEST_SKIP() << "no " << file << "; set ENSONIFY_SHARED";
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto azimuth = uniform_sine_beams(256, radians(60.0));
  ASSERT_GT(bytes.size(), 122u + 512u);
  double worst = 0;
  for (std::size_t b = 0; b < 256; ++b) {
    const auto low = static_cast<unsigned char>(bytes[122 + 2 * b]);
    const auto high = static_cast<signed char>(bytes[123 + 2 * b]);
    const double bearing_deg = 0.01 * (256 * high + low);  // rising, starboard positive or negative: symmetric
    worst = std::max(worst, std::abs(bearing_deg - degrees(azimuth[255 - b])));
  }
  std::printf("worst bearing: %.4f deg\n", worst);
  EXPECT_LE(worst, 0.0101);
}

class BadSonar : public testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("ensonify_bad_sonar_" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  /// The bundled HF sonar with one text replaced; the message it is refused with, empty where it loads.
  std::string refusal(const std::string& from, const std::string& to, const RangeWindow& window = {}) {
    return refusal({{from, to}}, window);
  }
  std::string refusal(const std::vector<std::pair<std::string, std::string>>& changes, const RangeWindow& window) {
    std::ifstream in(library_folder("sensor_models") / "oculus_m1200d_hf.yaml");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    for (const auto& [from, to] : changes) {
      const auto at = text.find(from);
      if (at == std::string::npos) return "no such text in the sonar: " + from;
      text.replace(at, from.size(), to);
    }
    std::ofstream(folder / "bad.yaml") << text;
    try {
      load_sonar((folder / "bad.yaml").string(), window);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return {};
  }
};

TEST_F(BadSonar, IsRefusedWithItsRule) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("gamma: 0.5", "gamma: 0.5"), "");
  EXPECT_THAT(refusal("frequency_hz: 2.1e6", "frequency_hz: 2.1"), HasSubstr("frequency_hz: must lie in"));
  EXPECT_THAT(refusal("bandwidth_hz", "bandwith_hz"), HasSubstr("did you mean 'bandwidth_hz'"));
  EXPECT_THAT(refusal("frequency_hz: 2.1e6", "frequency_hz: 2.1e5"),
              HasSubstr("bandwidth_hz: must be at most frequency_hz, 210000"));
  EXPECT_THAT(refusal("count: 512", "count: 0"), HasSubstr("beams.count"));
  EXPECT_THAT(refusal("count: 512", "count: 1e6"), HasSubstr("beams.count"));
  EXPECT_THAT(refusal("azimuth_fov_deg: 60", "azimuth_fov_deg: 180"), HasSubstr("azimuth_fov_deg"));
  EXPECT_THAT(refusal("uniform_sine", "uniform_sin"), HasSubstr("uniform_angle, uniform_sine, listed"));
  EXPECT_THAT(refusal("azimuth_shading: hann", "azimuth_shading: han"), HasSubstr("azimuth_shading"));
  EXPECT_THAT(refusal("azimuth_width_deg: 0.4", "azimuth_width_deg: 0"), HasSubstr("azimuth_width_deg"));
  EXPECT_THAT(refusal("gamma: 0.5", "gamma: 0"), HasSubstr("receive.gamma"));
  EXPECT_THAT(refusal("bits: 8", "bits: 12"), HasSubstr("8 or 16"));
  EXPECT_THAT(refusal("native_bin_m: 0.002842", "native_bin_m: 0"), HasSubstr("native_bin_m"));
  EXPECT_THAT(refusal("bits: 8", "bits: 8\n  extra: 1"), HasSubstr("extra: unknown key"));
  EXPECT_THAT(refusal("gamma", "gamma", {{}, 50.0, {}}), HasSubstr("must lie within the instrument's"));
  EXPECT_THAT(refusal("gamma", "gamma", {6.0, {}, {}}), HasSubstr("must lie within the instrument's"));
  EXPECT_THAT(refusal("gamma", "gamma", {.range_min_m = 0.1, .range_max_m = 0.1001, .range_bins = 0}),
              HasSubstr("bins"));
}

// At 149.85 m (512 bins up to 150 m) 220 + 40 log10(r) + 2 * 1.4 r - 180 = 546.6 dB. At 0.1048 m (512 bins from 0.1 to
// 5 m) 100 + 40 log10(r) + 2 * 1.4 r - 400 = -338.9 dB.
TEST_F(BadSonar, GainThatSinglePrecisionDoesNotHold) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("tvg_absorption_db_per_m: 1.4 ", "tvg_absorption_db_per_m: 10 ", {0.1, 10.0, {}}), "");  // 279 dB
  EXPECT_EQ(refusal("max_m: 10,", "max_m: 150,"), "");  // the window decides, not the instrument
  const std::string loud = refusal("max_m: 10,", "max_m: 150,", {0.1, 150.0, {}});
  EXPECT_THAT(loud, HasSubstr("receive.tvg_absorption_db_per_m: at 149.9 m"));
  EXPECT_THAT(loud, HasSubstr("gives a gain of 547 dB; it must lie in [-300, 300] dB: lower the TVG or shorten"));
  EXPECT_THAT(refusal({{"source_level_db: 220", "source_level_db: 100"}, {"level_db: 180", "level_db: 400"}}, {}),
              HasSubstr("gives a gain of -339 dB"));
}

// A geometry tells the width of a beam's cell by its neighbours: a lone beam would leave maps, fan views and what pings
// observe empty without a word.
TEST_F(BadSonar, LoneBeam) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal("count: 512", "count: 1"), HasSubstr("beams.count: must give 2 to 4096 beams, not 1"));
  EXPECT_THAT(
      refusal("{spacing: uniform_sine, count: 512, azimuth_fov_deg: 60}", "{spacing: listed, azimuth_deg: [3]}"),
      HasSubstr("beams.azimuth_deg: must give 2 to 4096 beams, not 1"));
  EXPECT_EQ(refusal("uniform_sine, count: 512, azimuth_fov_deg: 60", "uniform_angle, count: 2, azimuth_fov_deg: 0.2"),
            "");
  const SonarGeometry two = load_sonar((folder / "bad.yaml").string()).geometry;
  EXPECT_NEAR(degrees(two.beam_edges_rad().front() - two.beam_edges_rad().back()), 0.4, 1e-9);
}

// Beams of 0.4 deg. Rays fill the cells between them at full gain, whatever the pattern says.
TEST_F(BadSonar, BeamsFurtherApartThanThreeWidths) {
  using testing::HasSubstr;
  const std::string table = "{spacing: uniform_sine, count: 512, azimuth_fov_deg: 60}";
  EXPECT_EQ(refusal(table, "{spacing: listed, azimuth_deg: [1.19, 0, -0.4]}"), "");
  const std::string sparse = refusal(table, "{spacing: listed, azimuth_deg: [0.4, 0, -1.21]}");
  EXPECT_THAT(sparse, HasSubstr("pattern.azimuth_width_deg: the beams at 0 and -1.21 deg lie 3.02 widths apart"));
  EXPECT_THAT(sparse, HasSubstr("give more beams or wider ones"));
  EXPECT_THAT(refusal("count: 512", "count: 40"), HasSubstr("3.67 widths apart"));  // 2 sin 30 / 39 in sin(azimuth)
}

TEST_F(BadSonar, ListedBeams) {
  using testing::HasSubstr;
  const std::string table = "{spacing: uniform_sine, count: 512, azimuth_fov_deg: 60}";
  EXPECT_EQ(refusal(table, "{spacing: listed, azimuth_deg: [1, 0.5, -0.5]}"), "");
  const SonarModel sonar = load_sonar((folder / "bad.yaml").string());
  EXPECT_NEAR(sonar.geometry.beam_azimuth_rad[2], radians(-0.5), 1e-12);
  EXPECT_EQ(refusal(table, "{spacing: listed, azimuth_deg: [-0.5, 0.5, 1]}"), "");  // rising: turned round
  EXPECT_NEAR(load_sonar((folder / "bad.yaml").string()).geometry.beam_azimuth_rad[0], radians(1.0), 1e-12);
  EXPECT_THAT(refusal(table, "{spacing: listed, azimuth_deg: []}"),
              HasSubstr("azimuth_deg: must give 2 to 4096 beams, not 0"));
  EXPECT_THAT(refusal(table, "{spacing: listed, azimuth_deg: [1, 3, 2]}"), HasSubstr("strictly"));
  EXPECT_THAT(refusal(table, "{spacing: listed, azimuth_deg: [1, 1]}"), HasSubstr("strictly"));
  EXPECT_THAT(refusal(table, "{spacing: listed, azimuth_deg: [100]}"), HasSubstr("must lie in"));
}

}  // namespace
}  // namespace ensonify
