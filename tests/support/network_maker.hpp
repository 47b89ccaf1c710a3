#pragma once

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/random.hpp"
#include "ensonify/filters/onnx_file.hpp"

namespace ensonify {

/// Networks with random weights as files would hold them, built node by node.
class NetworkMaker {
 public:
  explicit NetworkMaker(std::uint64_t seed = 1) : key_(RandomKey::from_seed(seed).child("network_maker")) {
    file_.input = "image";
    file_.input_sides = {1, 1, -1, -1};
  }

  std::string conv(const std::string& from, int in, int out, int side) {
    return convolution("Conv", from, {out, in, side, side}, out, in * side * side);
  }
  std::string transpose(const std::string& from, int in, int out) {
    return convolution("ConvTranspose", from, {in, out, 4, 4}, out, in * 4);
  }
  std::string join(const std::vector<std::string>& from) {
    OnnxNode node{"Concat", from, {}, {{"axis", {1}}}, {}};
    return add(std::move(node));
  }
  std::string activate(const std::string& operation, const std::string& from) {
    OnnxNode node{operation, {from}, {}, {}, {}};
    if (operation == "LeakyRelu") node.floats["alpha"] = 0.2F;
    return add(std::move(node));
  }
  /// Ends in a sigmoid of `from`.
  OnnxFile end(const std::string& from) {
    file_.output = activate("Sigmoid", from);
    return file_;
  }

 private:
  std::string add(OnnxNode node) {
    node.outputs = {fmt::format("v{}", file_.nodes.size())};
    file_.nodes.push_back(std::move(node));
    return file_.nodes.back().outputs.front();
  }
  std::string tensor(std::vector<std::int64_t> shape, double scale) {
    std::int64_t count = 1;
    for (const std::int64_t side : shape) count *= side;
    std::vector<float> values(static_cast<std::size_t>(count));
    for (float& value : values) value = static_cast<float>(scale * (2 * uniform_at(key_, drawn_++) - 1));
    const std::string name = fmt::format("t{}", file_.tensors.size());
    file_.tensors[name] = {std::move(shape), std::move(values)};
    return name;
  }
  std::string convolution(const char* operation, const std::string& from, const std::vector<std::int64_t>& shape,
                          int out, int fan_in) {
    const std::int64_t side = shape[2], stride = side == 4 ? 2 : 1, pad = (side - 1) / 2;
    const std::string weights = tensor(shape, std::sqrt(6.0 / fan_in)), bias = tensor({out}, 0.1);
    OnnxNode node{operation,
                  {from, weights, bias},
                  {},
                  {{"dilations", {1, 1}},
                   {"group", {1}},
                   {"kernel_shape", {side, side}},
                   {"pads", {pad, pad, pad, pad}},
                   {"strides", {stride, stride}}},
                  {}};
    return add(std::move(node));
  }

  RandomKey key_;
  std::uint64_t drawn_ = 0;
  OnnxFile file_;
};

/// The U-Net of ensonify.training: channels ngf, 2 ngf, 4 ngf, 8 ngf, 8 ngf ..., `depth` halvings.
inline OnnxFile random_unet(int ngf, int depth = 6, int heads = 1, std::uint64_t seed = 1) {
  NetworkMaker net(seed);
  std::vector<int> widths;
  for (int i = 0; i < depth; ++i) widths.push_back(ngf * std::min(1 << i, 8));
  std::vector<std::string> skips;
  std::string x = "image";
  for (int i = 0; i < depth; ++i) {
    x = i == 0 ? net.conv(x, 1, widths[0], 4) : net.conv(net.activate("LeakyRelu", x), widths[i - 1], widths[i], 4);
    skips.push_back(x);
  }
  for (int i = depth - 1; i >= 0; --i) {
    const bool inner = i == depth - 1;
    if (!inner) x = net.join({skips[i], x});
    x = net.transpose(net.activate("Relu", x), inner ? widths[i] : 2 * widths[i], i == 0 ? heads : widths[i - 1]);
  }
  return net.end(x);
}

}  // namespace ensonify
