#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "ensonify/core/image2.hpp"
#include "ensonify/filters/network.hpp"

namespace ensonify {

/// What stands beside a model, docs/learned_filter.md.
struct ModelCard {
  std::string network;                      ///< unet or pix2pix
  std::array<double, 2> input_range{0, 1};  ///< what grey levels 0 and 255 become
  double threshold = 0.5;                   ///< of the probability, chosen on validation
};

/// What a network says about an image, each of the image's size.
struct LearnedOutput {
  Image2<float> probability;           ///< of an echo, 0..1
  std::optional<Image2<float>> clean;  ///< the image without noise as a share of white, 0..1, where the model gives one
};

/// A network that is ready to run. Any number of threads may use one at once. The same bits for any number of threads;
/// other processors may differ in the last ones.
class LearnedModel {
 public:
  /// Loads FILE.onnx and its card FILE.json. Throws DataError: missing, broken, or no network of
  /// docs/learned_filter.md.
  explicit LearnedModel(const std::filesystem::path& onnx);

  const ModelCard& card() const { return card_; }

  /// Whether the network gives a clean image too.
  bool cleans() const { return network_.heads() == 2; }

  /// For grey levels (held to 0..255) of any size; mirrored at the far sides up to the multiple that the network needs.
  /// Throws DataError where the image is too large to run.
  LearnedOutput outputs(const Image2<float>& grey) const;
  Image2<float> probability(const Image2<float>& grey) const { return outputs(grey).probability; }

 private:
  std::string where_;
  Network network_;
  ModelCard card_;
};

}  // namespace ensonify
