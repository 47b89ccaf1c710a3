#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

/// What OpenCV does well, under this room's parameters and with a mirrored border.
namespace ensonify {

/// Median of the window. Of images that are not 8-bit, windows above 5 are slow.
struct Median {
  static constexpr const char* name = "median";
  static constexpr const char* source = "Tukey 1977; OpenCV";
  static constexpr FilterRole role = FilterRole::despeckles;
  WindowSize window;
  static constexpr auto parameters() { return std::array{window_parameter<Median>()}; }
};

/// Mean weighted by Gaussians of distance and of difference in grey level.
struct Bilateral {
  static constexpr const char* name = "bilateral";
  static constexpr const char* source = "Tomasi and Manduchi 1998; OpenCV";
  static constexpr FilterRole role = FilterRole::despeckles;
  WindowSize window{9};
  double sigma_range = 60, sigma_space = 3;
  static constexpr auto parameters() {
    using P = FilterParameter<Bilateral>;
    return std::array{
        window_parameter<Bilateral>(),
        P{"sigma_range", &Bilateral::sigma_range, "width of the weight on difference", {1e-3, 1e4}, "grey levels"},
        P{"sigma_space", &Bilateral::sigma_space, "width of the weight on distance", {1e-3, 1e3}, "px"}};
  }
};

/// Non-local means: pixels weighted by the likeness (L1) of the patches about them. Levels are rounded to 1/256 and
/// held to 0..255.
struct Nlm {
  static constexpr const char* name = "nlm";
  static constexpr const char* source = "Buades, Coll, Morel 2005; OpenCV";
  static constexpr FilterRole role = FilterRole::despeckles;
  double h = 25;
  WindowSize patch{7}, search{21};
  static constexpr auto parameters() {
    using P = FilterParameter<Nlm>;
    return std::array{P{"h", &Nlm::h, "strength", {1e-3, 1e3}, "grey levels"},
                      P{"patch", &Nlm::patch, "side of the patches, odd", {3, 21}, "px"},
                      P{"search", &Nlm::search, "side of the area that is searched, odd", {3, 61}, "px"}};
  }
};

Image2<float> apply(const Median& method, const GreyImage& image);
Image2<float> apply(const Bilateral& method, const GreyImage& image);
Image2<float> apply(const Nlm& method, const GreyImage& image);

}  // namespace ensonify
