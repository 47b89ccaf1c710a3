// Across beams a point is seen through |B(sin theta - sin theta_0)|^2, half at +-sin(w / 2): its -3 dB width on the
// axis is w, and off it asin(sin theta_0 + s) - asin(sin theta_0 - s), s = sin(w / 2), about w / cos theta_0.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sensor_models/point_spread.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

constexpr double width_deg = 0.4;

enum class Table { uniform_angle, uniform_sine, listed };

SonarModel sonar_with(Table table, Shading shading) {
  SonarModel sonar = test::bare_sonar({.bins = 100});
  auto& azimuth = sonar.geometry.beam_azimuth_rad;
  constexpr int beams = 2049;
  if (table == Table::uniform_angle) azimuth = uniform_angle_beams(beams, radians(130.0));
  if (table == Table::uniform_sine) azimuth = uniform_sine_beams(beams, radians(130.0));
  if (table == Table::listed) {  // steps that grow and shrink by half
    azimuth.clear();
    for (int b = 0; b < beams; ++b) {
      azimuth.push_back(radians(65.0 - 130.0 * b / (beams - 1) + 0.2 * std::sin(0.08 * b)));
    }
  }
  sonar.receive_azimuth = Aperture(shading, radians(width_deg));
  return sonar;
}

/// Angle (rad) between the half-power points of a row, linear between beams.
double half_power_width(const std::vector<double>& azimuth, std::span<const float> row, int peak) {
  const double half = 0.5 * static_cast<double>(row[peak]);
  const auto crossing = [&](int step) {
    int b = peak;
    while (static_cast<double>(row[b + step]) > half) b += step;
    const double inside = static_cast<double>(row[b]);
    const double share = (inside - half) / (inside - static_cast<double>(row[b + step]));
    return azimuth[b] + share * (azimuth[b + step] - azimuth[b]);
  };
  return crossing(-1) - crossing(1);
}

class BeamWidth : public testing::TestWithParam<std::tuple<Table, Shading>> {};

TEST_P(BeamWidth, OnAxisAndWideningOffIt) {
  const SonarModel sonar = sonar_with(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const PointSpread spread(sonar);
  const auto& azimuth = sonar.geometry.beam_azimuth_rad;
  const double s = std::sin(radians(0.5 * width_deg));
  for (const double theta_deg : {0.0, 15.0, -30.0, 45.0, 60.0}) {
    const int beam = *sonar.geometry.beam_of(radians(theta_deg));
    Image2<float> point(100, sonar.geometry.beams());
    point(50, beam) = 1.0F;
    const Image2<float> image = spread.apply(point);
    const double theta = azimuth[beam];
    const double expected = std::asin(std::sin(theta) + s) - std::asin(std::sin(theta) - s);
    ASSERT_NEAR(expected, radians(width_deg) / std::cos(theta), 1e-4 * expected);
    const double measured = half_power_width(azimuth, image.row(50), beam);
    EXPECT_NEAR(measured / expected, 1.0, 0.01) << theta_deg << " deg: " << degrees(measured);
    EXPECT_EQ(test::peak_cell(image), std::pair(50, beam));
    double column = 0;  // a target on a beam's axis keeps its level there
    for (int bin = 0; bin < 100; ++bin) column += static_cast<double>(image(bin, beam));
    EXPECT_NEAR(column, 1.0, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, BeamWidth,
                         testing::Combine(testing::Values(Table::uniform_angle, Table::uniform_sine, Table::listed),
                                          testing::Values(Shading::hann, Shading::hamming, Shading::uniform)));

// Across range: a Gaussian of full width c / (2 B) at half power, averaged over a bin: sums to one, and its variance
// is sigma^2 (pulse) + 1/12 + 1/12 bins^2 (the echo's place in its bin, and the width of the bin it falls into).
TEST(PulseWidth, SumAndVariance) {
  const SonarModel sonar = test::bare_sonar({.range_min_m = 1.0, .range_max_m = 2.0, .bins = 1000});
  const PointSpread spread(sonar);
  const double fwhm_bins = 1490.0 / (2.0 * 262e3) / 1e-3;
  const double sigma = fwhm_bins / (2.0 * std::sqrt(2.0 * std::log(2.0)));
  const auto& weights = spread.range_weights();
  const int reach = static_cast<int>(weights.size()) / 2;
  double sum = 0;
  double variance = 0;
  for (int k = -reach; k <= reach; ++k) {
    const double w = static_cast<double>(weights[k + reach]);
    sum += w;
    variance += w * k * k;
    EXPECT_EQ(weights[k + reach], weights[reach - k]);
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
  EXPECT_NEAR(variance / (sigma * sigma + 1.0 / 6.0), 1.0, 0.01);
}

}  // namespace
}  // namespace ensonify
