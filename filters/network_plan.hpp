#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "ensonify/filters/activation.hpp"
#include "ensonify/filters/onnx_file.hpp"

/// What an engine does to run a network, for images of any size: convolutions, each of which writes its result to where
/// the next ones read it, activated as they need it. So activations and concatenations are no steps of their own.
namespace ensonify {

/// Numbers of one kind, one after the other: planes [channel][row][column], or blocks [channel / block][row][column]
/// [channel % block] as oneDNN computes on them. Sides are those of the image, halved so often.
struct NetworkBuffer {
  int channels = 0;  ///< a multiple of the block, or planes
  int halvings = 0;
  bool planes = false;
};

constexpr int image_buffer = 0, output_buffer = 1;

/// Where a result goes: to `channel` and the next ones of a buffer.
struct NetworkSink {
  int buffer = 0;
  int channel = 0;
  std::vector<Activation> activations;
};

/// A convolution's weights [out / block][in / block][row][column][in % block][out % block], 0 for channels that only fill
/// a block; of planes (one channel) [out / block][row][column][out % block].
struct NetworkKernel {
  int side = 0;
  int in = 0, out = 0;  ///< channels, rounded up to blocks
  std::vector<float> weights;
  std::vector<float> bias;
};

/// The image as blocks.
struct Spread {};
/// Kernel of odd side and stride 1, or of side 4 and stride 2.
struct Convolve {
  NetworkKernel kernel;
};
/// A transposed convolution of side 4 and stride 2 is four convolutions of side 2, one for each parity of the result's
/// row and column: result (2 y + a, 2 x + b) by kernels[2 a + b] from rows y - 1 + a, y + a.
struct Transpose {
  std::array<NetworkKernel, 4> kernels;
};
/// The same, to few channels, which would fill little of a block: kernels[i] gives the shares of the i-th block of input
/// channels in all 16 cells that an input pixel adds to, as channel 16 c + 4 row + column.
struct TransposeToPlanes {
  std::vector<NetworkKernel> kernels;
  std::vector<float> bias;
};

struct NetworkStep {
  std::variant<Spread, Convolve, Transpose, TransposeToPlanes> kind;
  int source = 0;    ///< buffer
  int channels = 0;  ///< of the result, not rounded
  int halvings = 0;  ///< of the result
  /// The first is of blocks (but for TransposeToPlanes, whose are planes all).
  std::vector<NetworkSink> sinks;
  std::optional<float> slope;  ///< of negative numbers, where the convolution itself activates them (ReLU: 0)
};

struct NetworkPlan {
  int block = 16;
  std::vector<NetworkBuffer> buffers;  ///< image_buffer, output_buffer, then the others
  std::vector<NetworkStep> steps;
};

/// `file` has passed check_network. `block`: how many channels lie beside each other, 8 or 16.
NetworkPlan plan_network(const OnnxFile& file, int block);

}  // namespace ensonify
