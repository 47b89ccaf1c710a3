#include "ensonify/filters/network_plan.hpp"

#include <algorithm>
#include <map>
#include <string>

namespace ensonify {
namespace {

/// Transposed convolutions to more channels than this fill blocks well enough.
constexpr int few_channels = 4;

/// A part of what flows along an edge: all channels of one step's result, activated.
struct Piece {
  std::size_t step;
  std::vector<Activation> activations;
};
using Flow = std::vector<Piece>;

/// Channel of the buffer of each channel of a convolution's input.
struct Input {
  int buffer;
  std::vector<int> channels;
};

/// A kernel of zeros.
NetworkKernel empty_kernel(int side, int in, int out) {
  NetworkKernel kernel{side, in, out, {}, {}};
  kernel.weights.resize(static_cast<std::size_t>(side) * side * in * out);
  kernel.bias.resize(static_cast<std::size_t>(out));
  return kernel;
}

class Planner {
 public:
  Planner(const OnnxFile& file, int block) : file_(file) {
    plan_.block = block;
    plan_.buffers = {{1, 0, true}, {0, 0, true}};
    plan_.steps.push_back({Spread{}, image_buffer, 1, 0, {}, {}});
    flows_[file.input] = {{0, {}}};
    for (const OnnxNode& node : file.nodes) flows_[node.outputs.front()] = flow_of(node);
    for (const Piece& piece : flows_.at(file.output)) {
      NetworkStep& step = plan_.steps[piece.step];
      step.sinks.push_back({output_buffer, plan_.buffers[output_buffer].channels, piece.activations});
      plan_.buffers[output_buffer].channels += step.channels;
    }
    for (NetworkStep& step : plan_.steps) finish(step);
    std::erase_if(plan_.steps, [](const NetworkStep& step) { return step.sinks.empty(); });
  }

  NetworkPlan take() { return std::move(plan_); }

 private:
  int rounded(int channels) const { return (channels + plan_.block - 1) / plan_.block * plan_.block; }

  Flow flow_of(const OnnxNode& node) {
    if (node.operation == "Conv") return convolved(node);
    if (node.operation == "ConvTranspose") return transposed(node);
    Flow flow;
    for (const std::string& name : node.inputs) {
      const Flow& part = flows_.at(name);
      flow.insert(flow.end(), part.begin(), part.end());
    }
    if (node.operation == "Concat") return flow;
    Activation activation = Relu{};
    if (node.operation == "Sigmoid") activation = Sigmoid{};
    if (node.operation == "LeakyRelu") {
      LeakyRelu leaky;
      if (const auto alpha = node.floats.find("alpha"); alpha != node.floats.end()) leaky.slope = alpha->second;
      activation = leaky;
    }
    for (Piece& piece : flow) piece.activations.push_back(activation);
    return flow;
  }

  /// The buffer of a convolution's input: made when it is first asked for, and a sink of the steps that fill it.
  const Input& input(const std::string& name) {
    if (const auto found = inputs_.find(name); found != inputs_.end()) return found->second;
    Input input{static_cast<int>(plan_.buffers.size()), {}};
    const Flow& flow = flows_.at(name);
    NetworkBuffer buffer{0, plan_.steps[flow.front().step].halvings, false};
    for (const Piece& piece : flow) {
      NetworkStep& step = plan_.steps[piece.step];
      step.sinks.push_back({input.buffer, buffer.channels, piece.activations});
      for (int c = 0; c < step.channels; ++c) input.channels.push_back(buffer.channels + c);
      buffer.channels += rounded(step.channels);
    }
    plan_.buffers.push_back(buffer);
    return inputs_.emplace(name, std::move(input)).first->second;
  }

  Flow add(NetworkStep step) {
    plan_.steps.push_back(std::move(step));
    return {{plan_.steps.size() - 1, {}}};
  }

  float& weight(NetworkKernel& kernel, int in, int out, int row, int column) const {
    const int inner = std::min(plan_.block, kernel.in), block = plan_.block;
    std::size_t at = static_cast<std::size_t>(out / block) * (kernel.in / inner) + in / inner;
    at = (at * kernel.side + row) * kernel.side + column;
    return kernel.weights[(at * inner + in % inner) * block + out % block];
  }

  std::vector<float> bias_of(const OnnxNode& node, int out) const {
    return node.inputs.size() == 3 ? file_.tensors.at(node.inputs[2]).values : std::vector<float>(out);
  }

  Flow convolved(const OnnxNode& node) {
    const OnnxTensor& weights = file_.tensors.at(node.inputs[1]);
    const int out = static_cast<int>(weights.shape[0]), side = static_cast<int>(weights.shape[2]);
    const Flow& flow = flows_.at(node.inputs.front());
    const bool of_image = flow.size() == 1 && flow.front().step == 0 && flow.front().activations.empty();
    const Input from = of_image ? Input{image_buffer, {0}} : input(node.inputs.front());
    const NetworkBuffer& source = plan_.buffers[from.buffer];
    NetworkKernel kernel = empty_kernel(side, source.channels, rounded(out));
    auto value = weights.values.begin();  // [out][in][row][column]
    for (int o = 0; o < out; ++o) {
      for (const int in : from.channels) {
        for (int k = 0; k < side * side; ++k) weight(kernel, in, o, k / side, k % side) = *value++;
      }
    }
    std::ranges::copy(bias_of(node, out), kernel.bias.begin());
    return add({Convolve{std::move(kernel)}, from.buffer, out, source.halvings + (side == 4 ? 1 : 0), {}, {}});
  }

  Flow transposed(const OnnxNode& node) {
    const OnnxTensor& weights = file_.tensors.at(node.inputs[1]);
    const int out = static_cast<int>(weights.shape[1]);
    const Input from = input(node.inputs.front());
    const NetworkBuffer& source = plan_.buffers[from.buffer];
    const std::vector<float> bias = bias_of(node, out);
    if (out <= few_channels && only_planes(node.outputs.front())) {
      const int block = plan_.block;
      TransposeToPlanes kind{{}, bias};
      kind.kernels.assign(source.channels / block, empty_kernel(1, block, 16 * out));
      for_weights(weights, from, [&](float value, int in, int o, int cell) {
        weight(kind.kernels[in / block], in % block, 16 * o + cell, 0, 0) = value;
      });
      return add({std::move(kind), from.buffer, out, source.halvings - 1, {}, {}});
    }
    Transpose kind;
    kind.kernels.fill(empty_kernel(2, source.channels, rounded(out)));
    for (NetworkKernel& kernel : kind.kernels) std::ranges::copy(bias, kernel.bias.begin());
    // Input row i adds to the results 2 i - 1 + row of the kernel: rows 1, 3 to even ones, from i and i - 1.
    for_weights(weights, from, [&](float value, int in, int o, int cell) {
      const int row = cell / 4, column = cell % 4, a = 1 - row % 2, b = 1 - column % 2;
      weight(kind.kernels[2 * a + b], in, o, 1 - row / 2, 1 - column / 2) = value;
    });
    return add({std::move(kind), from.buffer, out, source.halvings - 1, {}, {}});
  }

  /// visit(value, channel of the buffer, channel of the result, 4 row + column) for weights [in][out][row][column].
  template <typename Visit>
  static void for_weights(const OnnxTensor& weights, const Input& from, const Visit& visit) {
    auto value = weights.values.begin();
    for (const int in : from.channels) {
      for (int o = 0; o < weights.shape[1]; ++o) {
        for (int cell = 0; cell < 16; ++cell) visit(*value++, in, o, cell);
      }
    }
  }

  /// No convolution sees this value.
  bool only_planes(const std::string& name) const {
    std::vector<std::string> seen{name};
    for (const OnnxNode& node : file_.nodes) {
      const bool uses = std::ranges::any_of(node.inputs, [&](const auto& in) { return std::ranges::count(seen, in); });
      if (!uses) continue;
      if (node.operation.starts_with("Conv")) return false;
      seen.push_back(node.outputs.front());
    }
    return true;
  }

  /// A sink of blocks first, where the raw result can lie.
  void finish(NetworkStep& step) {
    if (step.sinks.empty() || std::holds_alternative<TransposeToPlanes>(step.kind)) return;
    const auto first = std::ranges::find_if(step.sinks, [&](const auto& s) { return !plan_.buffers[s.buffer].planes; });
    if (first != step.sinks.end()) {
      std::iter_swap(step.sinks.begin(), first);
      if (step.sinks.size() == 1 && !std::holds_alternative<Spread>(step.kind)) fuse(step);
      return;
    }
    step.sinks.insert(step.sinks.begin(), {static_cast<int>(plan_.buffers.size()), 0, {}});
    plan_.buffers.push_back({rounded(step.channels), step.halvings, false});
  }

  static void fuse(NetworkStep& step) {
    std::vector<Activation>& activations = step.sinks.front().activations;
    if (activations.empty() || std::holds_alternative<Sigmoid>(activations.front())) return;
    const auto* leaky = std::get_if<LeakyRelu>(&activations.front());
    step.slope = leaky ? leaky->slope : 0.0F;
    activations.erase(activations.begin());
  }

  const OnnxFile& file_;
  NetworkPlan plan_;
  std::map<std::string, Flow> flows_;
  std::map<std::string, Input> inputs_;
};

}  // namespace

NetworkPlan plan_network(const OnnxFile& file, int block) { return Planner(file, block).take(); }

}  // namespace ensonify
