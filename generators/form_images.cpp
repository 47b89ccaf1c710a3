#include "ensonify/generators/form_images.hpp"

#include <cmath>

#include "ensonify/noise/disturb_echo.hpp"
#include "ensonify/noise/image_stages.hpp"
#include "ensonify/sensor_models/receive_chain.hpp"

namespace ensonify {
namespace {

Image2<std::uint8_t> mask_of(const Image2<std::uint8_t>& clean, int threshold) {
  Image2<std::uint8_t> mask(clean.rows(), clean.columns());
  const std::span<const std::uint8_t> in = clean.pixels();
  const std::span<std::uint8_t> out = mask.pixels();  // spans by value, since a byte may be part of any object
  for (std::size_t i = 0; i < in.size(); ++i) out[i] = in[i] >= threshold ? 255 : 0;
  return mask;
}

/// Mean powers of a pixel after the point spread.
struct MeanPowers {
  const Image2<float>& direct;
  const Image2<float>& multipath;  ///< may be empty
  const Image2<float>& sidelobe;   ///< may be empty
};

/// Power over full scale whose grey level is rounded up to the threshold.
float power_at_threshold(const SonarModel& sonar, int threshold) {
  return static_cast<float>(std::pow((threshold - 0.5) / 255.0, 2.0 / sonar.receive.gamma));
}

/// The strongest of direct, multipath and sidelobe where that reaches the threshold (of direct: where the mask is set),
/// else shadow behind what occludes half of the elevation arc, else water.
Image2<std::uint8_t> labels_of(const SonarModel& sonar, int threshold, const Image2<std::uint8_t>& mask,
                               const MeanPowers& power, const std::vector<int>& shadow_start_bin) {
  Image2<std::uint8_t> labels(mask.rows(), mask.columns());
  const float least_over_full_scale = power_at_threshold(sonar, threshold);
  const std::vector<float> gains = row_gains(sonar);
  const auto beams = static_cast<std::size_t>(mask.columns());
  std::vector<float> strongest(beams);
  std::vector<int> label(beams);
  for (int bin = 0; bin < mask.rows(); ++bin) {
    const auto set = mask.row(bin);
    const auto direct = power.direct.row(bin);
    for (std::size_t b = 0; b < beams; ++b) {
      const PixelLabel behind = bin >= shadow_start_bin[b] ? PixelLabel::shadow : PixelLabel::water;
      label[b] = static_cast<int>(set[b] != 0 ? PixelLabel::direct : behind);
      strongest[b] = set[b] != 0 ? direct[b] : 0.0f;
    }
    const float least = least_over_full_scale / gains[bin];
    const auto compete = [&](const Image2<float>& layer, PixelLabel name) {
      if (layer.empty()) return;
      const auto in = layer.row(bin);
      for (std::size_t b = 0; b < beams; ++b) {
        const bool wins = in[b] >= least && in[b] > strongest[b];
        label[b] = wins ? static_cast<int>(name) : label[b];
        strongest[b] = wins ? in[b] : strongest[b];
      }
    };
    compete(power.multipath, PixelLabel::multipath);
    compete(power.sidelobe, PixelLabel::sidelobe);
    const std::span<std::uint8_t> out = labels.row(bin);
    const std::span<const int> names = label;
    for (std::size_t b = 0; b < beams; ++b) out[b] = static_cast<std::uint8_t>(names[b]);
  }
  return labels;
}

SonarModel amplified(SonarModel sonar, double gain_db) {
  sonar.receive.saturation_level_db -= gain_db;
  return sonar;
}

}  // namespace

TraceOptions trace_options(const NoiseChain& noise, bool cell_truth) {
  TraceOptions options;
  options.cell_truth = cell_truth;
  options.elevation = noise.find<CoherentSpeckle>() != nullptr || noise.find<Texture>() != nullptr;
  if (const auto* multipath = noise.find<Multipath>()) {
    options.multipath_order = static_cast<int>(std::lround(multipath->order));
    options.multipath_samples = multipath->samples;
  }
  return options;
}

PingImages form_images(const Receiver& receiver, const Ping& ping, const ImageSettings& settings,
                       const PingSetting& setting) {
  const SonarModel& sonar = receiver.sonar;
  PingImages images;
  const Image2<float> direct = receiver.spread.apply(ping.echo.direct);
  images.clean.level = receive(sonar, direct);
  images.clean.grey = quantise(images.clean.level);
  images.mask = mask_of(images.clean.grey, settings.mask_threshold);

  const SonarModel with_gain = amplified(sonar, settings.gain_db);
  if (settings.noise.acts_before_image()) {
    ReceivedEcho received = disturb_echo(settings.noise, ping.echo, receiver, setting);
    images.raw.level = receive(with_gain, received.power);
    images.labels = labels_of(sonar, settings.mask_threshold, images.mask,
                              {direct, received.multipath, received.sidelobe}, ping.truth.shadow_start_bin);
    images.multipath = std::move(received.layers.multipath);
    images.sidelobe = std::move(received.sidelobe);
  } else {
    images.raw.level = settings.gain_db == 0.0 ? images.clean.level : receive(with_gain, direct);
    images.labels =
        labels_of(sonar, settings.mask_threshold, images.mask, {direct, {}, {}}, ping.truth.shadow_start_bin);
  }
  images.raw.level = disturb_image(settings.noise, std::move(images.raw.level), sonar.geometry, setting.ping);
  images.raw.grey = quantise(images.raw.level);
  return images;
}

}  // namespace ensonify
