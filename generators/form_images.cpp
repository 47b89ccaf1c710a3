#include "ensonify/generators/form_images.hpp"

#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify {
namespace {

Image2<std::uint8_t> mask_of(const Image2<std::uint8_t>& clean, int threshold) {
  Image2<std::uint8_t> mask(clean.rows(), clean.columns());
  for (std::size_t i = 0; i < clean.size(); ++i) mask.pixels()[i] = clean.pixels()[i] >= threshold ? 255 : 0;
  return mask;
}

/// Direct echo where the mask is set, else shadow behind what occludes half of the elevation arc, else water.
Image2<std::uint8_t> labels_of(const Image2<std::uint8_t>& mask, const std::vector<int>& shadow_start_bin) {
  Image2<std::uint8_t> labels(mask.rows(), mask.columns());
  for (int bin = 0; bin < mask.rows(); ++bin) {
    const auto in = mask.row(bin);
    const auto out = labels.row(bin);
    for (std::size_t b = 0; b < out.size(); ++b) {
      const PixelLabel behind = bin >= shadow_start_bin[b] ? PixelLabel::shadow : PixelLabel::water;
      out[b] = static_cast<std::uint8_t>(in[b] != 0 ? PixelLabel::direct : behind);
    }
  }
  return labels;
}

}  // namespace

PingImages form_images(const SonarModel& sonar, const PointSpread& spread, const Echo& echo, const PingTruth& truth,
                       const ImageSettings& settings, RandomKey key) {
  PingImages images;
  const Image2<float> intensity = spread.apply(echo.direct);
  images.clean.level = receive(sonar, intensity);
  images.clean.grey = quantise(images.clean.level);
  images.mask = mask_of(images.clean.grey, settings.mask_threshold);
  images.labels = labels_of(images.mask, truth.shadow_start_bin);

  SonarModel amplified = sonar;
  amplified.receive.saturation_level_db -= settings.gain_db;
  images.raw.level =
      disturb(settings.noise, settings.gain_db == 0.0 ? images.clean.level : receive(amplified, intensity), key);
  images.raw.grey = quantise(images.raw.level);
  return images;
}

}  // namespace ensonify
