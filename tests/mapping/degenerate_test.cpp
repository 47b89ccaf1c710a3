// Pings that make no sense are refused with what is wrong, and leave the map as it was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/integrate_ping.hpp"
#include "mapping/synthetic.hpp"

namespace ensonify {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

const double nan = std::nan("");

class BadPing : public testing::Test {
 protected:
  template <typename Change>
  void refused(const char* because, const Change& change) {
    for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
      PosedImage ping = noise_image(sonar(60, 20, 3, 40, 30), Pose::Identity(), 1);
      change(ping);
      EXPECT_THAT([&] { integrate_ping(ping, 10, inverse_model_named(kind), grid); },
                  ThrowsMessage<DataError>(HasSubstr(because)))
          << kind;
    }
    EXPECT_EQ(volume_m3(grid, [](MilliLogOdds v) { return v != 0; }), 0);
  }

  LogOddsGrid grid{box_frame({-1, -1, -1}, {2, 1, 1}, 0.1)};
};

TEST_F(BadPing, Poses) {
  refused("no finite numbers", [](PosedImage& p) { p.T_world_sonar.translation().y() = nan; });
  refused("no finite numbers", [](PosedImage& p) { p.T_world_sonar.matrix()(0, 1) = nan; });
  refused("no rotation", [](PosedImage& p) { p.T_world_sonar.linear() *= 1.1; });
  refused("no rotation", [](PosedImage& p) { p.T_world_sonar.linear() *= -1; });
  refused("2^28 cells", [](PosedImage& p) { p.T_world_sonar.translation().y() = 1e12; });
}

TEST_F(BadPing, Images) {
  refused("empty image", [](PosedImage& p) { p.grey = Image2<float>(); });
  refused("rows must be bins", [](PosedImage& p) { p.grey = Image2<std::uint8_t>(30, 40); });
  refused("bin 3, beam 4 is no number", [](PosedImage& p) {
    Image2<float> image(40, 30);
    image(3, 4) = static_cast<float>(nan);
    p.grey = image;
  });
}

TEST_F(BadPing, Geometries) {
  refused("range window", [](PosedImage& p) { p.geometry.range_min_m = 5; });
  refused("range window", [](PosedImage& p) { p.geometry.range_max_m = std::numeric_limits<double>::infinity(); });
  refused("elevation field of view", [](PosedImage& p) { p.geometry.elevation_fov_rad = 0; });
  refused("beam", [](PosedImage& p) { p.geometry.beam_azimuth_rad[7] = nan; });
  refused("descend", [](PosedImage& p) { std::swap(p.geometry.beam_azimuth_rad[7], p.geometry.beam_azimuth_rad[8]); });
  refused("180 deg", [](PosedImage& p) {
    for (double& a : p.geometry.beam_azimuth_rad) a *= 10;
  });
}

TEST_F(BadPing, OracleWithoutElevations) {
  PosedImage ping = noise_image(sonar(60, 20, 3, 40, 30), Pose::Identity(), 1);
  ping.elevation_rad = {};
  EXPECT_THAT([&] { integrate_ping(ping, 10, Oracle{}, grid); }, ThrowsMessage<DataError>(HasSubstr("true elevation")));
}

TEST_F(BadPing, ParametersOutOfRange) {
  const PosedImage ping = noise_image(sonar(60, 20, 3, 40, 30), Pose::Identity(), 1);
  EXPECT_THROW(integrate_ping(ping, nan, Arc{}, grid), ConfigError);
  EXPECT_THROW(integrate_ping(ping, 10, Arc{.step = {.free = 1, .occupied = 2}, .shape = {}}, grid), ConfigError);
  EXPECT_THROW(integrate_ping(ping, 10, Arc{.step = {}, .shape = {.footprint_cells = -1}}, grid), ConfigError);
  EXPECT_THROW(integrate_ping(ping, 10, Carve{.step = {}, .shape = {.elevation_share = 1.5}}, grid), ConfigError);
  EXPECT_THAT([] { inverse_model_named("cone"); },
              ThrowsMessage<ConfigError>(HasSubstr("points, arc, arc_shadow, carve, oracle")));
  EXPECT_STREQ(kind_of(inverse_model_named("arc_shadow")), "arc_shadow");
}

TEST(GoodPing, BesideTheMapItChangesNothing) {
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    LogOddsGrid grid(box_frame({-1, -1, -1}, {2, 1, 1}, 0.1));
    const Pose away = pose_from_xyz_rpy({50, -900, 3}, 0, 0, 1);
    integrate_ping(noise_image(sonar(60, 20, 3, 40, 30), away, 1), 10, inverse_model_named(kind), grid);
    EXPECT_EQ(volume_m3(grid, [](MilliLogOdds v) { return v != 0; }), 0) << kind;
  }
}

TEST(GoodPing, OnePixelAndOneCell) {
  for (const char* kind : {"points", "arc", "arc_shadow", "carve", "oracle"}) {
    LogOddsGrid grid(box_frame({0, -0.5, -0.5}, {1, 0.5, 0.5}, 1));
    SonarGeometry g = sonar(60, 20, 3, 1, 1);
    integrate_ping(noise_image(g, Pose::Identity(), 1), 10, inverse_model_named(kind), grid);
    // A beam without neighbours has no width, so that no centre falls into its arc.
    EXPECT_EQ(grid.at({0, 0, 0}) != 0, std::string_view(kind) == "points") << kind;
  }
}

}  // namespace
}  // namespace ensonify
