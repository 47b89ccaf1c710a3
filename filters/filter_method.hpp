#pragma once

#include <variant>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/cfar.hpp"
#include "ensonify/filters/diffusion.hpp"
#include "ensonify/filters/finishing.hpp"
#include "ensonify/filters/frost.hpp"
#include "ensonify/filters/learned.hpp"
#include "ensonify/filters/lee_family.hpp"
#include "ensonify/filters/opencv_filters.hpp"
#include "ensonify/filters/wavelet.hpp"
#include "ensonify/filters/wiener.hpp"

namespace ensonify {

/// The closed set. A new method is a struct with its parameters, an `apply`, and an entry here.
using FilterMethod = std::variant<Lee, LeeEnhanced, Kuan, Frost, GammaMap, Srad, Anisodiff, Wavelet, Wiener, Median,
                                  Bilateral, Nlm, Cfar, Unet, UnetClean, Pix2Pix, Threshold, Mask, Unsharp, Equalize>;

/// Despecklers may work on 255 ln(1 + I) / ln 256, where speckle is additive; levels below 0 count as 0.
enum class FilterDomain { linear, log };
constexpr std::array<const char*, 2> choice_names(FilterDomain) { return {"linear", "log"}; }

struct FilterStep {
  FilterMethod method;
  FilterDomain domain = FilterDomain::linear;
};

inline const char* name_of(const FilterMethod& method) {
  return std::visit([](const auto& m) { return m.name; }, method);
}
inline FilterRole role_of(const FilterMethod& method) {
  return std::visit([](const auto& m) { return m.role; }, method);
}

}  // namespace ensonify
