#include "ensonify/filters/learned.hpp"

#include <fmt/format.h>

#include <type_traits>

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

template <typename Method>
Image2<float> mask_of(const Method& method, const GreyImage& image) {
  const LearnedModel& model = model_of(method);
  const double least = method.threshold.value_or(model.card().threshold);
  Image2<float> mask = model.probability(image.grey);
  for (float& pixel : mask.pixels()) pixel = pixel >= least ? 255.0F : 0.0F;
  return mask;
}

}  // namespace

Image2<float> apply(const Unet& method, const GreyImage& image) { return mask_of(method, image); }
Image2<float> apply(const UnetClean& method, const GreyImage& image) {
  Image2<float> clean = model_of(method).outputs(image.grey).clean.value();
  for (float& pixel : clean.pixels()) pixel *= 255.0F;
  return clean;
}
Image2<float> apply(const Pix2Pix& method, const GreyImage& image) { return mask_of(method, image); }
void check(const Unet& method) { model_of(method); }
void check(const UnetClean& method) { model_of(method); }
void check(const Pix2Pix& method) { model_of(method); }

}  // namespace ensonify
