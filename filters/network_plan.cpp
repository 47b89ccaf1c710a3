#include "ensonify/filters/network_plan.hpp"

#include <map>
#include <string>

namespace ensonify {
namespace {

/// A part of what flows along an edge: all channels of one step's result, activated.
struct Piece {
  std::size_t step;
  std::vector<Activation> activations;
};
using Flow = std::vector<Piece>;

class Planner {
 public:
  explicit Planner(const OnnxFile& file) : file_(file) {
    plan_.buffers = {{1, 0}, {0, 0}};
    plan_.steps.push_back({Copy{}, image_buffer, 1, 0, {}, {}});
    flows_[file.input] = {{0, {}}};
    inputs_[file.input] = image_buffer;
    for (const OnnxNode& node : file.nodes) flows_[node.outputs.front()] = flow_of(node);
    fill(output_buffer, flows_.at(file.output));
    for (NetworkStep& step : plan_.steps) fuse(step);
    std::erase_if(plan_.steps, [](const NetworkStep& step) { return step.sinks.empty(); });
  }

  NetworkPlan take() { return std::move(plan_); }

 private:
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

  /// The buffer becomes a sink of the steps that fill it.
  void fill(int buffer, const Flow& flow) {
    NetworkBuffer& filled = plan_.buffers[buffer];
    for (const Piece& piece : flow) {
      NetworkStep& step = plan_.steps[piece.step];
      step.sinks.push_back({buffer, filled.channels, piece.activations});
      filled.channels += step.channels;
      filled.halvings = step.halvings;
    }
  }

  /// The buffer of a convolution's input: made when it is first asked for.
  int input(const std::string& name) {
    const auto [found, is_new] = inputs_.emplace(name, static_cast<int>(plan_.buffers.size()));
    if (is_new) {
      plan_.buffers.emplace_back();
      fill(found->second, flows_.at(name));
    }
    return found->second;
  }

  Flow add(NetworkStep step) {
    plan_.steps.push_back(std::move(step));
    return {{plan_.steps.size() - 1, {}}};
  }

  std::vector<float> bias_of(const OnnxNode& node, int out) const {
    return node.inputs.size() == 3 ? file_.tensors.at(node.inputs[2]).values : std::vector<float>(out);
  }

  Flow convolved(const OnnxNode& node) {
    const OnnxTensor& weights = file_.tensors.at(node.inputs[1]);
    const int out = static_cast<int>(weights.shape[0]), in = static_cast<int>(weights.shape[1]);
    const int side = static_cast<int>(weights.shape[2]), source = input(node.inputs.front());
    return add({Convolve{{side, in, out, weights.values, bias_of(node, out)}},
                source,
                out,
                plan_.buffers[source].halvings + (side == 4 ? 1 : 0),
                {},
                {}});
  }

  Flow transposed(const OnnxNode& node) {
    const OnnxTensor& weights = file_.tensors.at(node.inputs[1]);
    const int in = static_cast<int>(weights.shape[0]), out = static_cast<int>(weights.shape[1]);
    const int source = input(node.inputs.front());
    NetworkKernel kernel{2, in, 4 * out, std::vector<float>(weights.values.size()), {}};
    auto value = weights.values.begin();  // [in][out][row][column]
    for (int i = 0; i < in; ++i) {
      for (int o = 0; o < out; ++o) {
        // Input row y adds to the rows 2 y - 1 + row: row 1 of the kernel to the even one of grid row y, 3 to that of
        // the next grid row, 2 and 0 to the odd ones.
        for (int cell = 0; cell < 16; ++cell) {
          const int row = cell / 4, column = cell % 4, a = 1 - row % 2, b = 1 - column % 2;
          const std::size_t channel = static_cast<std::size_t>(2 * a + b) * out + o;
          kernel.weights[((channel * in + i) * 2 + 1 - row / 2) * 2 + 1 - column / 2] = *value++;
        }
      }
    }
    for (int parity = 0; parity < 4; ++parity) {
      const std::vector<float> bias = bias_of(node, out);
      kernel.bias.insert(kernel.bias.end(), bias.begin(), bias.end());
    }
    return add({Transpose{std::move(kernel)}, source, out, plan_.buffers[source].halvings - 1, {}, {}});
  }

  /// What a convolution can activate itself.
  static void fuse(NetworkStep& step) {
    if (step.sinks.size() != 1 || std::holds_alternative<Copy>(step.kind)) return;
    std::vector<Activation>& activations = step.sinks.front().activations;
    if (activations.empty() || std::holds_alternative<Sigmoid>(activations.front())) return;
    const auto* leaky = std::get_if<LeakyRelu>(&activations.front());
    step.slope = leaky ? leaky->slope : 0.0F;
    activations.erase(activations.begin());
  }

  const OnnxFile& file_;
  NetworkPlan plan_;
  std::map<std::string, Flow> flows_;
  std::map<std::string, int> inputs_;
};

}  // namespace

NetworkPlan plan_network(const OnnxFile& file) { return Planner(file).take(); }

}  // namespace ensonify
