#pragma once

#include <memory>
#include <vector>

#include "ensonify/core/image2.hpp"
#include "ensonify/filters/onnx_file.hpp"

namespace ensonify {

/// A network that is ready to run, by oneDNN's convolutions. Any number of threads may use one at once. Images of a
/// size that came before find their memory and compiled convolutions again.
class Network {
 public:
  /// Throws DataError as check_network does.
  explicit Network(const OnnxFile& file);
  ~Network();
  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;

  /// What the sides of an image must be multiples of.
  int multiple() const;
  /// Channels of the result, 1 or 2.
  int heads() const;

  /// The result's channels, each of the size of the image, on the threads of the current oneTBB arena: the same bits
  /// for any number of them. Throws DataError where the image is too large, or a side is no multiple.
  std::vector<Image2<float>> run(const Image2<float>& image) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ensonify
