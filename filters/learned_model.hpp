#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// What stands beside a model, docs/learned_filter.md.
struct ModelCard {
  std::string network;                      ///< unet or pix2pix
  std::array<double, 2> input_range{0, 1};  ///< what grey levels 0 and 255 become
  double threshold = 0.5;                   ///< of the probability, chosen on validation
};

/// A network that is ready to run. Any number of threads may use one at once: each gets a copy of its own, made when
/// it is first needed. The same bits for any number of threads; other processors may differ in the last ones.
class LearnedModel {
 public:
  /// Loads FILE.onnx and its card FILE.json. Throws DataError: missing, broken, or no network of
  /// docs/learned_filter.md.
  explicit LearnedModel(const std::filesystem::path& onnx);
  ~LearnedModel();

  const ModelCard& card() const;

  /// Probability of an echo, 0..1, for grey levels (held to 0..255) of any size; mirrored at the far sides up to the
  /// multiple that the network needs. Throws DataError where the image is too large to run.
  Image2<float> probability(const Image2<float>& grey) const;

 private:
  struct Networks;
  std::unique_ptr<Networks> networks_;
};

}  // namespace ensonify
