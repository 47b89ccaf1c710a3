#pragma once

#include "ensonify/filters/onnx_file.hpp"

namespace ensonify {

struct OnnxNeeds {
  int multiple = 1;  ///< what the sides of an image must be multiples of
  int heads = 1;     ///< channels of the output
};

/// Follows channels and scale through the network. Throws DataError unless it takes one channel [1, 1, bins, beams] to
/// one or two channels of the same size that end in a sigmoid, by these steps: Conv (kernel 4, stride 2, pad 1 halves;
/// an odd kernel with stride 1 keeps the size), ConvTranspose (kernel 4, stride 2, pad 1), Concat of channels, Relu,
/// LeakyRelu, Sigmoid; each uses only what came before it. At most 1000 nodes, 4096 channels and 2^28 weights, so that
/// a hostile file can not ask for more memory than there is before it has an image.
OnnxNeeds check_network(const OnnxFile& file);

}  // namespace ensonify
