#pragma once

#include <array>
#include <optional>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"
#include "ensonify/filters/model_file.hpp"

/// Masks and clean images by networks that ensonify.training trained; docs/learned_filter.md.
namespace ensonify {

/// The bundled model that was trained on the acoustics of a real sonar.
constexpr const char* usual_model = "realistic";

template <typename Method>
constexpr FilterParameter<Method> model_parameter(const char* otherwise = "") {
  return {"model", &Method::model, "the network, with its card (.json) beside it", {}, "", otherwise};
}

template <typename Method>
constexpr std::array<FilterParameter<Method>, 3> learned_parameters(const char* model_otherwise = "") {
  using P = FilterParameter<Method>;
  return {model_parameter<Method>(model_otherwise),
          P{"threshold", &Method::threshold, "least probability of an echo", {0, 1}, "", "the card's"},
          P{"output", &Method::output, "the mask, or the probability times 255"}};
}

/// A U-Net trained by cross-entropy and Dice.
struct Unet {
  static constexpr const char* name = "unet";
  static constexpr const char* network = name;
  static constexpr const char* source = "Ronneberger, Fischer, Brox 2015, with the layers of pix2pix; oneDNN";
  static constexpr FilterRole role = FilterRole::detects;
  ModelFile model{usual_model};
  std::optional<double> threshold;
  EchoOutput output = EchoOutput::mask;
  static constexpr auto parameters() { return learned_parameters<Unet>(); }
};

/// The clean image of the same network, where it was trained to give one.
struct UnetClean {
  static constexpr const char* name = "unet_clean";
  static constexpr const char* network = "unet";
  static constexpr const char* source = "as unet";
  static constexpr FilterRole role = FilterRole::despeckles;
  ModelFile model{usual_model};
  static constexpr std::array<FilterParameter<UnetClean>, 1> parameters() { return {model_parameter<UnetClean>()}; }
};

/// The U-Net of Isola, Zhu, Zhou, Efros 2017, trained against a discriminator, as Lin et al. 2023 use it.
struct Pix2Pix {
  static constexpr const char* name = "pix2pix";
  static constexpr const char* network = name;
  static constexpr const char* source = "Isola, Zhu, Zhou, Efros 2017; use of Lin et al. 2023; oneDNN";
  static constexpr FilterRole role = FilterRole::detects;
  ModelFile model;
  std::optional<double> threshold;
  EchoOutput output = EchoOutput::mask;
  static constexpr auto parameters() { return learned_parameters<Pix2Pix>("must be given"); }
};

/// Throws ConfigError: no model is named, it is of the other network, or gives no clean image; DataError: it is broken.
Image2<float> apply(const Unet& method, const GreyImage& image);
Image2<float> apply(const UnetClean& method, const GreyImage& image);
Image2<float> apply(const Pix2Pix& method, const GreyImage& image);

/// The same errors before any image is there.
void check(const Unet& method);
void check(const UnetClean& method);
void check(const Pix2Pix& method);

}  // namespace ensonify
