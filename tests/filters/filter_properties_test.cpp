#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"

namespace ensonify {
namespace {

struct Size {
  int rows, columns;
};

/// Odd, even, one row, one column, one pixel, smaller than any window.
rc::Gen<Size> sizes() {
  return rc::gen::element(Size{17, 23}, Size{1, 40}, Size{40, 1}, Size{1, 1}, Size{2, 3}, Size{3, 2}, Size{32, 32},
                          Size{5, 64});
}

/// Levels of a quarter of a grey step, many of them alike or 0.
Image2<float> levels(Size size) {
  Image2<float> image(size.rows, size.columns);
  const auto values = *rc::gen::container<std::vector<int>>(
      image.size(), rc::gen::weightedOneOf<int>({{1, rc::gen::just(0)}, {6, rc::gen::inRange(0, 1021)}}));
  std::ranges::transform(values, image.pixels().begin(), [](int v) { return static_cast<float>(v) / 4.0F; });
  return image;
}

/// What a network was trained to say, no property binds: learned methods have tests of their own.
bool learned(const MethodInfo& method) {
  return std::ranges::find(method.parameters, "model", &ParameterInfo::name) != method.parameters.end();
}

std::vector<FilterStep> despecklers() {
  std::vector<FilterStep> steps;
  for (const MethodInfo& method : filter_methods()) {
    if (method.role == FilterRole::despeckles && !learned(method)) steps.push_back(make_filter(method.name));
  }
  return steps;
}

FilterStep any_despeckler() { return *rc::gen::elementOf(despecklers()); }

Image2<float> filtered(const FilterStep& step, const Image2<float>& grey, GreyDepth depth = GreyDepth::real) {
  return apply({"test", {step}}, {grey, depth}).grey;
}

Image2<float> transposed(const Image2<float>& image) {
  Image2<float> out(image.columns(), image.rows());
  for (int i = 0; i < image.rows(); ++i) {
    for (int j = 0; j < image.columns(); ++j) out(j, i) = image(i, j);
  }
  return out;
}

void expect_near(const Image2<float>& a, const Image2<float>& b, float tolerance) {
  RC_ASSERT(a.rows() == b.rows());
  RC_ASSERT(a.columns() == b.columns());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const float difference = std::abs(a.pixels()[i] - b.pixels()[i]);
    if (!(difference <= tolerance)) RC_LOG() << "at " << i << ": " << a.pixels()[i] << " and " << b.pixels()[i] << "\n";
    RC_ASSERT(difference <= tolerance);
  }
}

RC_GTEST_PROP(FilterProperties, AConstantStays, ()) {
  const FilterStep step = any_despeckler();
  RC_LOG() << name_of(step.method) << "\n";
  const Size size = *sizes();
  const auto level = static_cast<float>(*rc::gen::inRange(0, 1021)) / 4.0F;
  const Image2<float> image(size.rows, size.columns, level);
  expect_near(filtered(step, image), image, level == 0.0F ? 0.0F : 1e-4F);
}

RC_GTEST_PROP(FilterProperties, AConstantStaysInTheLogDomain, ()) {
  FilterStep step = any_despeckler();
  step.domain = FilterDomain::log;
  const Size size = *sizes();
  const auto level = static_cast<float>(*rc::gen::inRange(0, 256));
  const Image2<float> image(size.rows, size.columns, level);
  // Non-local means rounds to 1/256 of the scale, which at white is 6 % of a level in 255 ln(1 + I) / ln 256.
  expect_near(filtered(step, image), image, std::holds_alternative<Nlm>(step.method) ? 0.05F : 1e-3F);
}

RC_GTEST_PROP(FilterProperties, EveryResultIsFiniteAndOfTheSameSize, ()) {
  for (const MethodInfo& method : filter_methods()) {
    if (learned(method)) continue;
    FilterStep step = make_filter(method.name);
    RC_LOG() << method.name << "\n";
    const Image2<float> image = levels(*sizes());
    for (const GreyDepth depth : {GreyDepth::bits8, GreyDepth::bits16, GreyDepth::real}) {
      const Image2<float> out = filtered(step, image, depth);
      RC_ASSERT(out.rows() == image.rows() && out.columns() == image.columns());
      RC_ASSERT(std::ranges::all_of(out.pixels(), [](float x) { return std::isfinite(x); }));
    }
  }
}

RC_GTEST_PROP(FilterProperties, PyRadarsReadingIsFiniteToo, ()) {
  for (const char* name : {"lee", "kuan", "lee_enhanced", "frost"}) {
    FilterStep step = make_filter(name);
    assign_parameter(step, "variant=pyradar");
    const Image2<float> out = filtered(step, levels(*sizes()));
    RC_ASSERT(std::ranges::all_of(out.pixels(), [](float x) { return std::isfinite(x); }));
  }
}

RC_GTEST_PROP(FilterProperties, RowsAndColumnsAreTreatedAlike, ()) {
  FilterStep step = any_despeckler();
  // Gamma-MAP jumps at cmax, which whole levels meet exactly; there the sums of rows decide.
  RC_PRE(!std::holds_alternative<GammaMap>(step.method));
  if (auto* diffusion = std::get_if<Anisodiff>(&step.method)) diffusion->step_row = 1.0, diffusion->step_col = 2.0;
  FilterStep turned = step;
  if (auto* diffusion = std::get_if<Anisodiff>(&turned.method)) diffusion->step_row = 2.0, diffusion->step_col = 1.0;
  RC_LOG() << name_of(step.method) << "\n";
  const Image2<float> image = levels(*sizes());
  // OpenCV's non-local means sums weights of whole numbers with cut divisions: 1/256 and some.
  expect_near(filtered(step, transposed(image)), transposed(filtered(turned, image)),
              std::holds_alternative<Nlm>(step.method) ? 0.02F : 2e-3F);
}

/// Vector code may treat the numbers before an aligned address in another way than the others.
RC_GTEST_PROP(FilterProperties, TheBitsDoNotDependOnWhereMemoryLies, ()) {
  FilterStep step = any_despeckler();
  RC_PRE(!std::holds_alternative<Nlm>(step.method));  // slow, and of whole numbers
  step.domain = *rc::gen::element(FilterDomain::linear, FilterDomain::log);
  RC_LOG() << name_of(step.method) << "\n";
  const Image2<float> image = levels({17, 23});
  const Image2<float> first = filtered(step, image);
  std::vector<std::vector<char>> between;
  for (int i = 0; i < 12; ++i) {
    between.emplace_back(static_cast<std::size_t>(*rc::gen::inRange(1, 200)) * 16);
    const Image2<float> moved = image;
    RC_ASSERT(filtered(step, moved) == first);
  }
}

/// f(a I) = a f(I) where all that a filter compares are ratios. Factors are powers of two: they do not round, for where
/// the image is so even that the finest diagonal band is zero but for rounding, the wavelet's rule (scikit-image's)
/// takes that rounding for the noise.
RC_GTEST_PROP(FilterProperties, BrighterImagesGiveBrighterResults, ()) {
  FilterStep step =
      make_filter(*rc::gen::element("lee", "kuan", "lee_enhanced", "frost", "wavelet", "wiener", "median"));
  RC_LOG() << name_of(step.method) << "\n";
  const float factor = *rc::gen::element(0.25F, 2.0F, 0x1p-10F);
  const Image2<float> image = levels(*sizes());
  Image2<float> brighter = image;
  for (float& x : brighter.pixels()) x *= factor;
  Image2<float> expected = filtered(step, image);
  for (float& x : expected.pixels()) x *= factor;
  expect_near(filtered(step, brighter), expected, 1e-3F * factor);
}

RC_GTEST_PROP(FilterProperties, DiffusionKeepsTheMean, ()) {
  FilterStep step = make_filter("anisodiff");
  assign_parameter(step, "iterations=20");
  assign_parameter(step, std::string("option=") + std::to_string(*rc::gen::inRange(1, 4)));
  const Image2<float> image = levels(*sizes());
  const Image2<float> out = filtered(step, image);
  const auto mean = [](const Image2<float>& x) {
    return std::accumulate(x.pixels().begin(), x.pixels().end(), 0.0) / static_cast<double>(x.size());
  };
  RC_ASSERT(std::abs(mean(out) - mean(image)) < 1e-6 * 255);
}

/// Perona and Malik 1990, section IV-A: the scheme makes no new extremes.
RC_GTEST_PROP(FilterProperties, DiffusionStaysBetweenTheExtremes, ()) {
  FilterStep step = make_filter("anisodiff");
  assign_parameter(step, "iterations=10");
  const Image2<float> image = levels(*sizes());
  const Image2<float> out = filtered(step, image);
  const auto [low, high] = std::ranges::minmax(image.pixels());
  for (const float x : out.pixels()) RC_ASSERT(x >= low - 1e-4F && x <= high + 1e-4F);
}

}  // namespace
}  // namespace ensonify
