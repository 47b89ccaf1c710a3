#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

namespace ensonify {

/// out = m + max(v - n, 0) / v (I - m), m and v mean and variance of the window, n the variance of the noise. Estimated
/// as scipy's wiener and MATLAB's wiener2 do: mean of v with zeros beyond the border. The result itself sees a mirrored
/// border.
struct Wiener {
  static constexpr const char* name = "wiener";
  static constexpr const char* source = "Lim 1990, p. 548";
  static constexpr FilterRole role = FilterRole::despeckles;
  WindowSize window;
  std::optional<double> noise;
  static constexpr auto parameters() {
    using P = FilterParameter<Wiener>;
    return std::array{
        window_parameter<Wiener>(),
        P{"noise", &Wiener::noise, "variance of the noise", {0, 1e9}, "grey levels squared", "mean of v"}};
  }
};

Image2<float> apply(const Wiener& method, const GreyImage& image);

}  // namespace ensonify
