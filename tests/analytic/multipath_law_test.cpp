// The bistatic law of surfaces, by itself.
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/scenes/material_library.hpp"
#include "ensonify/sim/bistatic.hpp"
#include "support/pings.hpp"

namespace ensonify {
namespace {

using namespace test;

Vec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

bistatic::Scattered scattered(const Material& material, const Vec3& i, const Vec3& o) {
  return bistatic::scatter(surface_law(material), static_cast<float>(i.z()), static_cast<float>(o.z()),
                           static_cast<float>(i.dot(o)));
}

/// The law in double, with the library's functions: mu cos i cos o + s (n.h)^N G.
double sigma(const Material& material, const Vec3& i, const Vec3& o) {
  const Vec3 h = (i + o).normalized();
  const double masking = std::min({1.0, 2.0 * h.z() * i.z() / i.dot(h), 2.0 * h.z() * o.z() / i.dot(h)});
  return std::pow(10.0, material.lambert_db / 10.0) * i.z() * o.z() +
         std::pow(10.0, material.specular_db / 10.0) * std::pow(h.z(), material.specular_exponent) * masking;
}

TEST(MultipathLaw, InnerLoopsKeepTheFormulaAndItIsReciprocal) {
  for (const Material& material : bundled_materials()) {
    const double peak = sigma(material, Vec3::UnitZ(), Vec3::UnitZ());
    for (double a = 0.05; a < 1.5; a += 0.1) {
      for (double b = 0.02; b < 1.5; b += 0.1) {
        for (double phi = 0.0; phi < 3.2; phi += 0.4) {
          const Vec3 i = direction(a, 0.3);
          const Vec3 o = direction(b, 0.3 + phi);
          const double expected = sigma(material, i, o);
          EXPECT_NEAR(static_cast<double>(scattered(material, i, o).sigma), expected, 1e-3 * expected + 1e-9 * peak);
          EXPECT_FLOAT_EQ(scattered(material, i, o).sigma, scattered(material, o, i).sigma) << material.name;
        }
      }
    }
  }
}

// With o = i the half vector is i: sigma = mu cos^2 i + s cos^N i, G = 2 cos^2 i >= 1 up to 45 degrees.
TEST(MultipathLaw, BackscatterIsThatOfTheDirectEcho) {
  for (const Material& material : bundled_materials()) {
    for (double a = 0.0; a <= radians(45.0); a += radians(1.0)) {
      const double expected = backscatter(material, std::cos(a));
      EXPECT_NEAR(static_cast<double>(scattered(material, direction(a, 0), direction(a, 0)).sigma), expected,
                  1e-3 * expected)
          << material.name << " at " << degrees(a);
    }
  }
}

// What leaves over what arrives: I_out = sigma(i, o) I_in dA and I_in cos i dA arrives, so the albedo is the integral
// of sigma over o divided by cos i. Lambert's part gives pi mu. For the lobe, dOmega_o = 4 (i.h) dOmega_h, and G <= 2
// (n.h)(n.i) / (i.h) or 1 makes it the share of V-grooves that i sees: at most 8 pi s / (N + 2).
TEST(MultipathLaw, NoSurfaceSendsOutMoreThanArrives) {
  for (const Material& material : bundled_materials()) {
    const double mu = std::pow(10.0, material.lambert_db / 10.0);
    const double s = std::pow(10.0, material.specular_db / 10.0);
    const double bound = std::numbers::pi * (mu + 8.0 * s / (material.specular_exponent + 2.0));
    EXPECT_LE(bound, 1.0) << material.name;
    for (const double incidence_deg : {0.0, 20.0, 45.0, 60.0, 75.0, 82.0, 86.0, 89.0}) {
      const Vec3 i = direction(radians(incidence_deg), 0.0);
      // Over half vectors, where the lobe is about the normal: dOmega_o = 4 (i.h) dOmega_h.
      double out = 0.0;
      constexpr int rings = 800;
      constexpr int around = 400;
      const double widest = std::min(0.5 * std::numbers::pi, 8.0 / std::sqrt(material.specular_exponent));
      for (int r = 0; r < rings; ++r) {
        const double theta = (r + 0.5) * widest / rings;
        for (int k = 0; k < around; ++k) {
          const Vec3 h = direction(theta, (k + 0.5) * 2.0 * std::numbers::pi / around);
          const Vec3 o = 2.0 * i.dot(h) * h - i;
          if (i.dot(h) <= 0.0 || o.z() <= 0.0) continue;
          const double lobe = sigma(material, i, o) - mu * i.z() * o.z();
          out += lobe * 4.0 * i.dot(h) * std::sin(theta) * (widest / rings) * (2.0 * std::numbers::pi / around);
        }
      }
      const double albedo = std::numbers::pi * mu + out / i.z();
      EXPECT_LE(albedo, bound * 1.002) << material.name << " at " << incidence_deg;
      if (incidence_deg == 0.0 && material.specular_exponent >= 25.0) {
        EXPECT_NEAR(albedo, bound, 0.02 * bound) << material.name;
      }
    }
  }
}

}  // namespace
}  // namespace ensonify
