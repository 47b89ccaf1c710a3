// Line apertures against Harris (1978): -3 dB points and first sidelobes.
#include "ensonify/sensor_models/aperture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/core/pose.hpp"

namespace ensonify {
namespace {

TEST(Aperture, HalfPowerAtHalfTheWidth) {
  for (const Shading shading : {Shading::uniform, Shading::hann, Shading::hamming, Shading::gaussian}) {
    for (const double width_deg : {0.1, 0.4, 2.0, 12.0, 60.0}) {
      const Aperture aperture(shading, radians(width_deg));
      const double half = std::sin(radians(0.5 * width_deg));
      EXPECT_NEAR(aperture.power(0.0), 1.0, 1e-12);
      EXPECT_NEAR(aperture.power(half), 0.5, 1e-9);
      EXPECT_NEAR(aperture.power(-half), 0.5, 1e-9);
      double before = 1.0;
      for (int i = 1; i <= 100; ++i) {  // the main lobe falls monotonically
        const double power = aperture.power(aperture.main_lobe_sine() * i / 100.0);
        EXPECT_LE(power, before + 1e-12);
        before = power;
      }
    }
  }
}

/// Highest level (dB) beyond the main lobe.
double sidelobe_db(const Aperture& aperture) {
  double highest = 0;
  for (double s = aperture.main_lobe_sine(); s < 20.0 * aperture.main_lobe_sine();
       s += 1e-3 * aperture.main_lobe_sine()) {
    highest = std::max(highest, aperture.power(s));
  }
  return 10.0 * std::log10(highest);
}

// uniform: sinc. hann: amplitude sinc(x) / (1 - x^2). hamming: 0.54 + 0.46 cos.
TEST(Aperture, FirstSidelobes) {
  EXPECT_NEAR(sidelobe_db(Aperture(Shading::uniform, radians(0.4))), -13.26, 0.05);
  EXPECT_NEAR(sidelobe_db(Aperture(Shading::hann, radians(0.4))), -31.47, 0.05);
  EXPECT_NEAR(sidelobe_db(Aperture(Shading::hamming, radians(0.4))), -42.7, 0.1);
}

// Width of the main lobe in half widths: first null over -3 dB point, uniform 1 / 0.443, hann 2 / 0.720.
TEST(Aperture, FirstNulls) {
  const double half = std::sin(radians(0.2));
  EXPECT_NEAR(Aperture(Shading::uniform, radians(0.4)).main_lobe_sine() / half, 1.0 / 0.44295, 1e-4);
  EXPECT_NEAR(Aperture(Shading::hann, radians(0.4)).main_lobe_sine() / half, 2.0 / 0.7203, 1e-3);
  for (const Shading shading : {Shading::uniform, Shading::hann, Shading::hamming}) {
    const Aperture aperture(shading, radians(0.4));
    EXPECT_NEAR(aperture.power(aperture.main_lobe_sine()), 0.0, 1e-12);
  }
}

TEST(Aperture, GaussianAndBox) {
  const Aperture gaussian(Shading::gaussian, radians(10.0));
  const double half = std::sin(radians(5.0));
  EXPECT_NEAR(gaussian.power(2.0 * half), std::pow(0.5, 4), 1e-9);  // 2^-(s / half)^2
  const Aperture box(Shading::box, radians(10.0));
  EXPECT_EQ(box.power(0.999 * half), 1.0);
  EXPECT_EQ(box.power(1.001 * half), 0.0);
}

TEST(Aperture, SineBeyondALevel) {
  for (const Shading shading : {Shading::uniform, Shading::hann, Shading::hamming, Shading::gaussian, Shading::box}) {
    const Aperture aperture(shading, radians(12.0));
    const double from = aperture.sine_beyond_db(-20.0);
    for (double s = from; s <= 1.0; s += 1e-4) ASSERT_LT(aperture.power(s), 0.01) << static_cast<int>(shading);
    bool above = false;
    for (double s = from - 3e-4; s < from; s += 1e-5) above |= aperture.power(s) >= 0.01;
    EXPECT_TRUE(above) << static_cast<int>(shading);
  }
}

}  // namespace
}  // namespace ensonify
