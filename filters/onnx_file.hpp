#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// What an ONNX file says. Source: onnx.proto3 of ONNX 1.6 (opset 11).
namespace ensonify {

struct OnnxNode {
  std::string operation;
  std::vector<std::string> inputs, outputs;
  std::map<std::string, std::vector<std::int64_t>> integers;  ///< attributes of one or several integers
  std::map<std::string, float> floats;                        ///< attributes of one number
};

struct OnnxTensor {
  std::vector<std::int64_t> shape;
  std::vector<float> values;  ///< all finite; the last axis varies fastest
};

struct OnnxFile {
  std::string input, output;
  std::vector<std::int64_t> input_sides;      ///< -1 where the file leaves a side open
  std::map<std::string, OnnxTensor> tensors;  ///< the weights
  std::vector<OnnxNode> nodes;
};

/// Reads a file of one input, one output and weights of 32-bit floats within the file. Throws DataError: no ONNX, cut
/// short, or with anything in it that such a file does not need (other files, other types, control flow).
OnnxFile read_onnx(std::string_view bytes);

}  // namespace ensonify
