#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "ensonify/filters/activation.hpp"
#include "ensonify/filters/onnx_file.hpp"

/// What an engine does to run a network, for images of any size: convolutions, each of which writes its result to where
/// the next ones read it, activated as they need it. So activations and concatenations are no steps of their own.
namespace ensonify {

/// Numbers [row][column][channel]; the sides are those of the image, halved so often.
struct NetworkBuffer {
  int channels = 0;
  int halvings = 0;
};

constexpr int image_buffer = 0, output_buffer = 1;

/// Where a result goes: to `channel` and the next ones of a buffer.
struct NetworkSink {
  int buffer = 0;
  int channel = 0;
  std::vector<Activation> activations;
};

/// Weights [out][in][row][column] and a number for each output.
struct NetworkKernel {
  int side = 0;
  int in = 0, out = 0;
  std::vector<float> weights, bias;
};

struct Copy {};
/// Kernel of odd side and stride 1, or of side 4 and stride 2.
struct Convolve {
  NetworkKernel kernel;
};
/// A transposed convolution of side 4 and stride 2: the result (2 y + a, 2 x + b), for each parity a, b, is a
/// convolution of side 2 that sees the rows y - 1 + a, y + a and such columns. So one convolution of side 2 over a grid
/// of a row and a column more gives all: channel c of the result (2 y + a, 2 x + b) is channel (2 a + b) out + c of
/// cell (y + a, x + b), which sees the rows and columns before it and of its own number.
struct Transpose {
  NetworkKernel kernel;
};

struct NetworkStep {
  std::variant<Copy, Convolve, Transpose> kind;
  int source = 0;    ///< buffer
  int channels = 0;  ///< of the result
  int halvings = 0;  ///< of the result
  std::vector<NetworkSink> sinks;
  std::optional<float> slope;  ///< of negative numbers, where the convolution itself activates them (ReLU: 0)
};

struct NetworkPlan {
  std::vector<NetworkBuffer> buffers;  ///< image_buffer, output_buffer, then what the convolutions read
  std::vector<NetworkStep> steps;
};

/// `file` has passed check_network.
NetworkPlan plan_network(const OnnxFile& file);

}  // namespace ensonify
