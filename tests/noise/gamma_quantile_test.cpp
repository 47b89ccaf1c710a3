#include "ensonify/noise/gamma_quantile.hpp"

#include <gtest/gtest.h>
#include <math.h>

#include <cmath>
#include <vector>

#include "ensonify/core/gamma_function.hpp"

namespace ensonify {
namespace {

TEST(GammaQuantile, InvertsTheDistribution) {
  for (const double shape : {0.1, 0.5, 1.0, 3.0, 40.0, 1000.0}) {
    const GammaQuantile quantile(shape);
    for (float p = 0.01F; p < 1.0F; p += 0.07F) {
      std::vector<float> x{p};
      quantile.apply(x);
      EXPECT_NEAR(gamma_distribution(shape, shape * static_cast<double>(x[0])), static_cast<double>(p), 1e-3) << shape;
    }
  }
}

// glibc's lgamma leaves the sign of Gamma in a global, which pings on other threads would write at the same time.
TEST(GammaQuantile, WritesNoGlobal) {
  ::signgam = 7;
  const GammaQuantile quantile(0.5);
  EXPECT_EQ(::signgam, 7);
}

}  // namespace
}  // namespace ensonify
