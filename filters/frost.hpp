#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

namespace ensonify {

/// Mean of the window weighted by exp(-damping Ci^2 d), d the distance in pixels from the centre, Ci = s / m of the
/// window.
struct Frost {
  static constexpr const char* name = "frost";
  static constexpr const char* source = "Frost, Stiles, Shanmugan, Holtzman 1982, in the form of Lopes et al. 1990";
  static constexpr FilterRole role = FilterRole::despeckles;
  FilterVariant variant = FilterVariant::published;
  WindowSize window;
  double damping = 1.0;
  static constexpr auto parameters() {
    return std::array{
        variant_parameter<Frost>(), window_parameter<Frost>(),
        FilterParameter<Frost>{"damping", &Frost::damping, "how fast weights fall with distance", {0, 1000}}};
  }
};

Image2<float> apply(const Frost& method, const GreyImage& image);

}  // namespace ensonify
