#pragma once

#include "ensonify/filters/onnx_file.hpp"

namespace ensonify {

/// What the sides of an image must be multiples of.
struct OnnxNeeds {
  int multiple = 1;
};

/// Follows channels and scale through the network. Throws DataError unless it takes one channel [1, 1, bins, beams] to
/// one channel of the same size that ends in a sigmoid, by these steps: Conv (kernel 4, stride 2, pad 1 halves; an odd
/// kernel with stride 1 keeps the size), ConvTranspose (kernel 4, stride 2, pad 1), Concat of channels, Relu,
/// LeakyRelu, Sigmoid; each uses only what came before it.
OnnxNeeds check_network(const OnnxFile& file);

}  // namespace ensonify
