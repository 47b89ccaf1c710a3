#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

/// Steps that follow a despeckler: its mask, and the post-processing of Lin et al. 2023, section III-C, whose
/// parameters the paper leaves open.
namespace ensonify {

/// 255 where the grey level is at least t, else 0.
struct Threshold {
  static constexpr const char* name = "threshold";
  static constexpr const char* source = "";
  static constexpr FilterRole role = FilterRole::detects;
  double t = 30;
  static constexpr auto parameters() {
    return std::array{
        FilterParameter<Threshold>{"t", &Threshold::t, "least level of an echo", {0, 256}, "grey levels"}};
  }
};

/// The raw image (of the same size; what the chain began with) where the level here is at least t, else 0.
struct Mask {
  static constexpr const char* name = "mask";
  static constexpr const char* source = "Lin et al. 2023";
  static constexpr FilterRole role = FilterRole::finishes;
  double t = 128;
  static constexpr auto parameters() {
    return std::array{FilterParameter<Mask>{"t", &Mask::t, "least level that keeps a pixel", {0, 256}, "grey levels"}};
  }
};

/// I + amount (I - Gaussian(I)), held to 0..255.
struct Unsharp {
  static constexpr const char* name = "unsharp";
  static constexpr const char* source = "Lin et al. 2023; parameters ours; OpenCV's Gaussian";
  static constexpr FilterRole role = FilterRole::finishes;
  double sigma = 1.0, amount = 1.0;
  static constexpr auto parameters() {
    using P = FilterParameter<Unsharp>;
    return std::array{P{"sigma", &Unsharp::sigma, "width of the Gaussian", {0.1, 100}, "px"},
                      P{"amount", &Unsharp::amount, "how much of the difference is added", {0, 100}}};
  }
};

/// Histogram equalisation of the image rounded to 8 bits.
struct Equalize {
  static constexpr const char* name = "equalize";
  static constexpr const char* source = "Lin et al. 2023; OpenCV";
  static constexpr FilterRole role = FilterRole::finishes;
  static constexpr auto parameters() { return std::array<FilterParameter<Equalize>, 0>{}; }
};

Image2<float> apply(const Threshold& method, const GreyImage& image);
Image2<float> apply(const Mask& method, const GreyImage& image, const GreyImage& raw);
Image2<float> apply(const Unsharp& method, const GreyImage& image);
Image2<float> apply(const Equalize& method, const GreyImage& image);

}  // namespace ensonify
