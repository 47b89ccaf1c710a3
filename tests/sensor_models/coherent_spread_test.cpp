// A lone scatterer through array and pulse: |field|^2 is the point spread.
#include "ensonify/sensor_models/coherent_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/sensor_models/beam_table.hpp"
#include "ensonify/sensor_models/point_spread.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

constexpr int beams = 513;

SonarModel instrument(Shading shading, double bin_m = 0.002842) {
  SonarModel sonar = bare_sonar({.range_min_m = 1.0, .range_max_m = 1.0 + 201 * bin_m, .bins = 201});
  sonar.geometry.beam_azimuth_rad = uniform_sine_beams(beams, radians(20.0));
  sonar.receive_azimuth = Aperture(shading, radians(0.4));
  return sonar;
}

Image2<float> point_through(const SonarModel& sonar) {
  ComplexField field(201, beams);
  field.real(100, beams / 2) = 0.6F;
  field.imaginary(100, beams / 2) = 0.8F;
  const ComplexField seen = CoherentSpread(sonar).apply(field);
  Image2<float> power(201, beams);
  for (std::size_t i = 0; i < power.size(); ++i) {
    power.pixels()[i] =
        seen.real.pixels()[i] * seen.real.pixels()[i] + seen.imaginary.pixels()[i] * seen.imaginary.pixels()[i];
  }
  return power;
}

/// Full width at half of the peak, linear between samples, in samples.
double half_width(const std::vector<double>& x) {
  const auto peak = static_cast<std::size_t>(std::max_element(x.begin(), x.end()) - x.begin());
  const auto crossing = [&](int step) {
    std::size_t i = peak;
    while (x[i] > 0.5 * x[peak]) i += static_cast<std::size_t>(step);
    const std::size_t inner = i - static_cast<std::size_t>(step);
    return std::abs(static_cast<double>(inner) - static_cast<double>(peak)) +
           (x[inner] - 0.5 * x[peak]) / (x[inner] - x[i]);
  };
  return crossing(1) + crossing(-1);
}

// Harris 1978: Hann -31.5 dB, Hamming -42.7 dB. The -3 dB width is the instrument's.
TEST(CoherentSpread, BeamWidthAndFirstSidelobe) {
  for (const auto& [shading, sidelobe_db] : {std::pair{Shading::hann, -31.47}, std::pair{Shading::hamming, -42.7}}) {
    const SonarModel sonar = instrument(shading);
    const Image2<float> power = point_through(sonar);
    std::vector<double> across;
    for (int b = 0; b < beams; ++b) across.push_back(static_cast<double>(power(100, b)));
    const double step_deg =
        degrees(sonar.geometry.beam_azimuth_rad[beams / 2] - sonar.geometry.beam_azimuth_rad[beams / 2 + 1]);
    EXPECT_NEAR(half_width(across) * step_deg, 0.4, 0.004);
    double sidelobe = 0;
    for (int b = 0; b < beams; ++b) {
      const double sine = std::abs(std::sin(sonar.geometry.beam_azimuth_rad[static_cast<std::size_t>(b)]));
      if (sine > sonar.receive_azimuth.main_lobe_sine())
        sidelobe = std::max(sidelobe, across[static_cast<std::size_t>(b)]);
    }
    EXPECT_NEAR(10.0 * std::log10(sidelobe / across[beams / 2]), sidelobe_db, 0.3);
  }
}

// Pulse c / (2 B) = 2.84 mm: with bins a tenth of it the -3 dB width is the pulse's, to the bin it is averaged over.
TEST(CoherentSpread, RangeWidthIsThePulse) {
  const SonarModel sonar = instrument(Shading::hann, 0.0002842);
  const Image2<float> power = point_through(sonar);
  std::vector<double> along;
  for (int bin = 0; bin < 201; ++bin) along.push_back(static_cast<double>(power(bin, beams / 2)));
  EXPECT_NEAR(half_width(along) * 0.0002842, 1490.0 / (2.0 * 262e3), 0.03 * 0.00284);
}

// What the clean image shows of a point is what the field has in its main lobe.
TEST(CoherentSpread, MainLobeIsThatOfTheCleanImage) {
  const SonarModel sonar = instrument(Shading::hann);
  Image2<float> point(201, beams);
  point(100, beams / 2) = 1.0F;
  const Image2<float> clean = PointSpread(sonar).apply(point);
  const Image2<float> field = point_through(sonar);
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (clean.pixels()[i] > 0.0F) {
      ASSERT_NEAR(static_cast<double>(field.pixels()[i] / clean.pixels()[i]), 1.0, 1e-4);
    }
  }
}

// Sidelobe power is the field's power beyond the main lobe.
TEST(CoherentSpread, SidelobePowerIsTheRest) {
  const SonarModel sonar = instrument(Shading::hann);
  Image2<float> point(201, beams);
  point(100, beams / 2) = 1.0F;
  const Image2<float> clean = PointSpread(sonar).apply(point);
  const Image2<float> sidelobe = CoherentSpread(sonar).sidelobe_power(point);
  const Image2<float> field = point_through(sonar);
  EXPECT_NEAR(sum_of(sidelobe) + sum_of(clean), sum_of(field), 1e-4 * sum_of(field));
  EXPECT_GT(sum_of(sidelobe), 1e-4 * sum_of(field));
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (sidelobe.pixels()[i] > 0.0F) {
      ASSERT_EQ(clean.pixels()[i], 0.0F);
    }
  }
}

// The fan is its own mirror image: what a beam sees of a scatterer, its mirror image sees of the mirrored one, also
// where beams and bins are not whole vectors (the last of 513, of 201).
TEST(CoherentSpread, EdgesOfTheImageSeeWhatItsMiddleSees) {
  const CoherentSpread spread(instrument(Shading::hann));
  const auto seen_of = [&](int bin, int beam) {
    ComplexField field(201, beams);
    field.real(bin, beam) = 1.0F;
    return spread.apply(field).real;
  };
  for (const int beam : {0, 5, beams / 2}) {
    const Image2<float> one = seen_of(100, beam);
    const Image2<float> mirrored = seen_of(200, beams - 1 - beam);
    for (int b = 0; b < beams; ++b) EXPECT_NEAR(one(100, b), mirrored(200, beams - 1 - b), 1e-5F) << beam << " " << b;
  }
}

// A beam at the border of the fan hears half of its lobe from beyond; of an even field it shows what the middle shows,
// but for the spacing beyond the border, which goes on in angle where the fan is even in its sine.
TEST(CoherentSpread, AnEvenFieldIsEvenToTheBorderOfTheFan) {
  for (const Shading shading : {Shading::uniform, Shading::hann}) {
    const SonarModel sonar = instrument(shading);
    const CoherentSpread coherent(sonar);
    const Image2<float> clean = PointSpread(sonar).apply(Image2<float>(201, beams, 1.0F));
    for (int b = 0; b < beams; ++b) {
      EXPECT_NEAR(static_cast<double>(clean(100, b) / clean(100, beams / 2)), 1.0, 1e-3) << b;
      EXPECT_NEAR(coherent.noise_gain()[static_cast<std::size_t>(b)] / coherent.noise_gain()[beams / 2], 1.0, 1e-3)
          << b;
    }
  }
}

}  // namespace
}  // namespace ensonify
