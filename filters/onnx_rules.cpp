#include "ensonify/filters/onnx_rules.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

using Integers = std::vector<std::int64_t>;

constexpr std::size_t most_nodes = 1000;
constexpr int most_halvings = 10;
constexpr std::int64_t most_channels = 4096;
constexpr int most_activations = 4;
/// With channels rounded up to blocks of 16, as the engine stores them.
constexpr std::int64_t most_weights = std::int64_t{1} << 28;

[[noreturn]] void fail(const std::string& what) {
  throw DataError(fmt::format("no network that ensonify can run: {}", what));
}

/// What flows along an edge of the network.
struct Flow {
  std::int64_t channels = 1;
  int halvings = 0;
  int activations = 0;  ///< since the last convolution
};

class Rules {
 public:
  explicit Rules(const OnnxFile& file) : file_(file) {
    const Integers& sides = file.input_sides;
    const bool images =
        sides.size() == 4 && sides[0] == 1 && sides[1] == 1 &&
        std::all_of(sides.begin() + 2, sides.end(), [](auto side) { return side >= -1 && side <= 65536; });
    if (!images) fail("its input must have the shape 1 x 1 x bins x beams");
    if (file.tensors.contains(file.input)) fail("its input is a weight");
    flows_[file.input] = {};
    if (file.nodes.empty() || file.nodes.size() > most_nodes)
      fail(fmt::format("it must have 1 to {} nodes", most_nodes));
    for (const OnnxNode& node : file.nodes) add(node);
    const Flow end = flow(file.output);
    if (end.channels > 2 || end.halvings != 0) fail("its output must have 1 or 2 channels and the size of the input");
    heads_ = static_cast<int>(end.channels);
    if (file.nodes.back().operation != "Sigmoid" || file.nodes.back().outputs.front() != file.output) {
      fail("it must end in a Sigmoid, so that its output lies in 0..1");
    }
  }

  OnnxNeeds needs() const { return {1 << halvings_, heads_}; }

 private:
  void add(const OnnxNode& node) {
    if (node.outputs.size() != 1 || node.inputs.empty()) fail(node.operation + " must have inputs and one output");
    const Flow result = passed(node);
    if (result.halvings < 0 || result.halvings > most_halvings) fail("its scales do not fit together");
    if (result.channels > most_channels) fail(fmt::format("it has more than {} channels", most_channels));
    if (result.activations > most_activations) fail("it has too many activations in a row");
    halvings_ = std::max(halvings_, result.halvings);
    if (file_.tensors.contains(node.outputs.front()) || !flows_.emplace(node.outputs.front(), result).second) {
      fail(fmt::format("'{}' is computed twice", node.outputs.front()));
    }
  }

  Flow passed(const OnnxNode& node) {
    const std::string& operation = node.operation;
    if (operation != "LeakyRelu" && !node.floats.empty()) fail(operation + " must have no attribute of a real number");
    if (operation == "Conv") return convolved(node, 1, 0, 1);
    if (operation == "ConvTranspose") return convolved(node, 0, 1, -1);
    if (operation == "Concat") {
      if (node.integers != std::map<std::string, Integers>{{"axis", {1}}}) fail("Concat must join channels");
      Flow joined = flow(node.inputs.front());
      for (std::size_t i = 1; i < node.inputs.size(); ++i) {
        const Flow other = flow(node.inputs[i]);
        if (other.halvings != joined.halvings) fail("Concat joins images of different sizes");
        joined.channels += other.channels;
        joined.activations = std::max(joined.activations, other.activations);
        if (joined.channels > most_channels) return joined;
      }
      return joined;
    }
    const bool leaky = operation == "LeakyRelu" && node.floats.size() == node.floats.count("alpha");
    if ((leaky || operation == "Relu" || operation == "Sigmoid") && node.integers.empty()) {
      if (node.inputs.size() != 1) fail(operation + " must have one input");
      Flow activated = flow(node.inputs.front());
      ++activated.activations;
      return activated;
    }
    fail(fmt::format("a node {} is not supported", operation.substr(0, 40)));
  }

  /// `in`, `out`: axes of the weights. `halves`: what a kernel of 4 does to the number of halvings.
  Flow convolved(const OnnxNode& node, std::size_t in, std::size_t out, int halves) {
    const Flow before = flow(node.inputs.front());
    if (node.inputs.size() < 2 || node.inputs.size() > 3)
      fail(node.operation + " must have weights, and may have a bias");
    const Integers& shape = weights(node.inputs[1]);
    if (shape.size() != 4 || shape[in] != before.channels) fail(fmt::format("'{}' has a wrong shape", node.inputs[1]));
    if (node.inputs.size() == 3 && weights(node.inputs[2]) != Integers{shape[out]}) {
      fail(fmt::format("'{}' has a wrong shape", node.inputs[2]));
    }
    const std::int64_t kernel = shape[2];
    const bool keeps = kernel % 2 == 1 && kernel <= 15 && halves > 0;
    if (shape[3] != kernel || (kernel != 4 && !keeps)) fail(fmt::format("'{}' has a wrong kernel", node.inputs[1]));
    const std::int64_t stride = keeps ? 1 : 2, pad = keeps ? kernel / 2 : 1;
    const std::map<std::string, Integers> expected{{"dilations", {1, 1}},
                                                   {"group", {1}},
                                                   {"kernel_shape", {kernel, kernel}},
                                                   {"pads", {pad, pad, pad, pad}},
                                                   {"strides", {stride, stride}}};
    if (node.integers != expected) {
      fail(fmt::format("{} of '{}': stride, padding, dilation or group is not supported", node.operation,
                       node.inputs[1]));
    }
    const auto rounded = [](std::int64_t channels) { return (channels + 15) / 16 * 16; };
    weights_ += rounded(shape[0]) * rounded(shape[1]) * kernel * kernel;
    if (weights_ > most_weights) fail(fmt::format("it has more than {} weights", most_weights));
    return {shape[out], before.halvings + (keeps ? 0 : halves)};
  }

  Flow flow(const std::string& name) const {
    const auto found = flows_.find(name);
    if (found == flows_.end()) fail(fmt::format("'{}' is used but computed nowhere before", name));
    return found->second;
  }
  const Integers& weights(const std::string& name) const {
    const auto found = file_.tensors.find(name);
    if (found == file_.tensors.end()) fail(fmt::format("weights '{}' are missing", name));
    return found->second.shape;
  }

  const OnnxFile& file_;
  std::map<std::string, Flow> flows_;
  int halvings_ = 0;
  int heads_ = 1;
  std::int64_t weights_ = 0;
};

}  // namespace

OnnxNeeds check_network(const OnnxFile& file) { return Rules(file).needs(); }

}  // namespace ensonify
