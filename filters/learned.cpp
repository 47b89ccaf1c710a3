#include "ensonify/filters/learned.hpp"

#include <fmt/format.h>

#include <type_traits>
#include <utility>

#include "ensonify/core/error.hpp"
#include "ensonify/filters/learned_model.hpp"

namespace ensonify {
namespace {

template <typename Method>
const LearnedModel& model_of(const Method& method) {
  try {
    const LearnedModel& model = method.model.loaded();
    if (model.card().network != method.network) {
      throw ConfigError(
          fmt::format("model {} is a {} network; use that method", method.model.name(), model.card().network));
    }
    if (std::is_same_v<Method, UnetClean> && !model.cleans()) {
      throw ConfigError(fmt::format("model {} gives no clean image, only probabilities of an echo; use method {}",
                                    method.model.name(), method.network));
    }
    return model;
  } catch (const ConfigError& e) {
    throw ConfigError(fmt::format("{}: {}", method.name, e.what()));
  }
}

Image2<float> to_levels(Image2<float> shares) {
  for (float& pixel : shares.pixels()) pixel *= 255.0F;
  return shares;
}

template <typename Method>
Image2<float> echoes(const Method& method, const GreyImage& image) {
  const LearnedModel& model = model_of(method);
  Image2<float> probability = model.probability(image.grey);
  if (method.output == EchoOutput::probability) return to_levels(std::move(probability));
  const double least = method.threshold.value_or(model.card().threshold);
  for (float& pixel : probability.pixels()) pixel = pixel >= least ? 255.0F : 0.0F;
  return probability;
}

}  // namespace

Image2<float> apply(const Unet& method, const GreyImage& image) { return echoes(method, image); }
Image2<float> apply(const Pix2Pix& method, const GreyImage& image) { return echoes(method, image); }
Image2<float> apply(const UnetClean& method, const GreyImage& image) {
  return to_levels(model_of(method).outputs(image.grey).clean.value());
}
void check(const Unet& method) { model_of(method); }
void check(const UnetClean& method) { model_of(method); }
void check(const Pix2Pix& method) { model_of(method); }

}  // namespace ensonify
