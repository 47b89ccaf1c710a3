#include "ensonify/scenes/water.hpp"

#include <gtest/gtest.h>

#include "ensonify/scenes/material.hpp"

namespace ensonify {
namespace {

TEST(SoundSpeed, MackenzieGivesItsPublishedCheckValue) {
  EXPECT_NEAR(sound_speed_mackenzie_mps(25, 35, 1000), 1550.744, 5e-4);
}

TEST(SoundSpeed, MackenzieAndMedwinAgreeInTheSea) {
  EXPECT_NEAR(sound_speed_mackenzie_mps(10, 35, 0), 1489.80, 0.01);
  EXPECT_NEAR(sound_speed_medwin_mps(10, 35, 0), 1489.99, 0.01);
}

TEST(SoundSpeed, FreshWaterTakesMedwin) {
  EXPECT_NEAR(sound_speed_mps({.temperature_c = 20, .salinity_psu = 0, .depth_m = 1}), 1481.6, 0.1);
  EXPECT_EQ(sound_speed_mps({.temperature_c = 10, .salinity_psu = 35, .depth_m = 5}),
            sound_speed_mackenzie_mps(10, 35, 5));
}

struct AbsorptionRow {
  double frequency_khz, sea_10c, sea_20c, fresh_20c, fresh_10c;  // dB/km at 5 m, pH 8
};

// Francois and Garrison 1982, evaluated apart from this code.
constexpr AbsorptionRow francois_garrison[] = {{375, 90, 118, 31, 44},        {750, 222, 219, 124, 175},
                                               {900, 299, 274, 178, 252},     {1200, 495, 414, 317, 447},
                                               {1800, 1055, 810, 713, 1007},  {2100, 1418, 1068, 970, 1370},
                                               {3000, 2845, 2078, 1981, 2797}};

TEST(Absorption, FollowsTheTableOfFrancoisAndGarrison) {
  for (const AbsorptionRow& row : francois_garrison) {
    const auto db_per_km = [&](double temperature_c, double salinity_psu) {
      const Water water{.temperature_c = temperature_c, .salinity_psu = salinity_psu, .depth_m = 5, .ph = 8};
      return 1000 * absorption_db_per_m(water, 1000 * row.frequency_khz);
    };
    EXPECT_NEAR(db_per_km(10, 35), row.sea_10c, 0.51) << row.frequency_khz;
    EXPECT_NEAR(db_per_km(20, 35), row.sea_20c, 0.51) << row.frequency_khz;
    EXPECT_NEAR(db_per_km(20, 0), row.fresh_20c, 0.51) << row.frequency_khz;
    EXPECT_NEAR(db_per_km(10, 0), row.fresh_10c, 0.51) << row.frequency_khz;
  }
}

TEST(Backscatter, IsLambertPlusLobe) {
  const Material material{.name = "m", .lambert_db = -20, .specular_db = -10, .specular_exponent = 50, .source = ""};
  EXPECT_NEAR(backscatter(material, 1.0), 0.01 + 0.1, 1e-12);
  EXPECT_NEAR(backscatter(material, 0.5), 0.01 * 0.25, 1e-12);  // the lobe is gone at 60 degrees
  EXPECT_EQ(backscatter(material, 0.0), 0.0);
}

}  // namespace
}  // namespace ensonify
