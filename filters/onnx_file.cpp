#include "ensonify/filters/onnx_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw DataError(fmt::format("no ONNX model that ensonify can run: {}", what));
}

/// One field of a message in protobuf's wire format: an integer, or bytes.
struct Field {
  int number = 0;
  std::uint64_t integer = 0;
  std::string_view bytes;
};

class Fields {
 public:
  explicit Fields(std::string_view message) : rest_(message) {}

  std::optional<Field> next() {
    if (rest_.empty()) return std::nullopt;
    const std::uint64_t key = varint();
    if (key >> 3 == 0 || key >> 3 > 1000) fail("its bytes are no protobuf message");
    Field field{static_cast<int>(key >> 3), 0, {}};
    switch (key & 7) {
      case 0:
        field.integer = varint();
        return field;
      case 1:
        field.bytes = take(8);
        return field;
      case 2:
        field.bytes = take(varint());
        return field;
      case 5:
        field.bytes = take(4);
        return field;
      default:
        fail("its bytes are no protobuf message");
    }
  }

 private:
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(take(1).front());
      value |= static_cast<std::uint64_t>(byte & 127U) << shift;
      if (byte < 128) return value;
    }
    fail("its bytes are no protobuf message");
  }
  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) fail("it is cut short");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::string_view rest_;
};

/// Calls visit(field) for every field. A field that visit does not know (it returns false) is refused: it might
/// change what the network computes.
template <typename Visit>
void for_fields(std::string_view message, const char* what, const Visit& visit) {
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (!visit(*field)) fail(fmt::format("{} has a field of number {}, which is not supported", what, field->number));
  }
}

void add_integers(const Field& field, std::vector<std::int64_t>& to) {
  if (field.bytes.data() == nullptr) return to.push_back(static_cast<std::int64_t>(field.integer));
  fail("its integers are packed");
}

float float_of(const Field& field) {
  float number = 0;
  if (field.bytes.size() != sizeof(float)) fail("a number has another type than its field");
  std::memcpy(&number, field.bytes.data(), sizeof(float));
  if (!std::isfinite(number)) fail("an attribute is not finite");
  return number;
}

void read_attribute(std::string_view message, OnnxNode& node) {
  std::string name;
  std::vector<std::int64_t> integers;
  std::optional<float> number;
  for_fields(message, "an attribute", [&](const Field& f) {
    if (f.number == 1) name = f.bytes;
    if (f.number == 2) number = float_of(f);
    if (f.number == 3 || f.number == 8) add_integers(f, integers);
    return f.number == 1 || f.number == 2 || f.number == 3 || f.number == 8 || f.number == 20;
  });
  const bool twice = node.integers.contains(name) || node.floats.contains(name);
  if (twice || (number && !integers.empty())) fail(fmt::format("attribute {} is there twice", name));
  if (number) {
    node.floats.emplace(name, *number);
  } else {
    node.integers.emplace(name, std::move(integers));
  }
}

OnnxNode read_node(std::string_view message) {
  OnnxNode node;
  for_fields(message, "a node", [&](const Field& f) {
    if (f.number == 1) node.inputs.emplace_back(f.bytes);
    if (f.number == 2) node.outputs.emplace_back(f.bytes);
    if (f.number == 4) node.operation = f.bytes;
    if (f.number == 5) read_attribute(f.bytes, node);
    return f.number >= 1 && f.number <= 6;
  });
  return node;
}

void read_tensor(std::string_view message, OnnxFile& file) {
  constexpr std::uint64_t floats = 1;
  std::string name;
  std::vector<std::int64_t> shape;
  std::uint64_t type = 0;
  std::string_view raw;
  for_fields(message, "a tensor", [&](const Field& f) {
    if (f.number == 1) add_integers(f, shape);
    if (f.number == 2) type = f.integer;
    if (f.number == 8) name = f.bytes;
    if (f.number == 9) raw = f.bytes;
    return f.number == 1 || f.number == 2 || f.number == 8 || f.number == 9;
  });
  if (type != floats) fail(fmt::format("tensor {} must hold 32-bit floats", name));
  std::uint64_t count = 1;
  for (const std::int64_t side : shape) {
    if (side < 1 || side > 65536 || count > raw.size()) fail(fmt::format("tensor {} has an impossible shape", name));
    count *= static_cast<std::uint64_t>(side);
  }
  if (count * sizeof(float) != raw.size()) fail(fmt::format("tensor {} has another length than its shape", name));
  OnnxTensor tensor{std::move(shape), std::vector<float>(count)};
  std::memcpy(tensor.values.data(), raw.data(), raw.size());
  for (const float weight : tensor.values) {
    if (!std::isfinite(weight)) fail(fmt::format("tensor {} holds {}; weights must be finite", name, weight));
  }
  if (!file.tensors.emplace(name, std::move(tensor)).second) fail(fmt::format("tensor {} is there twice", name));
}

/// Name and sides of an input or output: ValueInfoProto { name, TypeProto { Tensor { type, shape { dim } } } }.
std::pair<std::string, std::vector<std::int64_t>> read_value(std::string_view message) {
  std::pair<std::string, std::vector<std::int64_t>> value;
  const auto read_side = [&](std::string_view bytes) {
    std::int64_t side = -1;
    for_fields(bytes, "a side", [&](const Field& f) {
      if (f.number == 1) side = static_cast<std::int64_t>(f.integer);
      return f.number == 1 || f.number == 2;
    });
    value.second.push_back(side);
  };
  for_fields(message, "an input or output", [&](const Field& named) {
    if (named.number == 1) value.first = named.bytes;
    if (named.number == 2) {
      for_fields(named.bytes, "a type", [&](const Field& tensor) {
        for_fields(tensor.bytes, "a type", [&](const Field& shape) {
          if (shape.number == 1 && shape.integer != 1) fail("its input and output must be 32-bit floats");
          if (shape.number == 2) {
            for_fields(shape.bytes, "a shape", [&](const Field& side) {
              read_side(side.bytes);
              return side.number == 1;
            });
          }
          return shape.number <= 2;
        });
        return tensor.number == 1;
      });
    }
    return named.number <= 2;
  });
  return value;
}

void set_once(std::string& name, const std::string& value, const char* what) {
  if (!name.empty() || value.empty()) fail(fmt::format("it must have one {}, with a name", what));
  name = value;
}

OnnxFile read_graph(std::string_view message) {
  OnnxFile file;
  for_fields(message, "the graph", [&](const Field& f) {
    if (f.number == 1) file.nodes.push_back(read_node(f.bytes));
    if (f.number == 5) read_tensor(f.bytes, file);
    if (f.number == 11) {
      auto [name, sides] = read_value(f.bytes);
      set_once(file.input, name, "input");
      file.input_sides = std::move(sides);
    }
    if (f.number == 12) set_once(file.output, read_value(f.bytes).first, "output");
    return f.number == 1 || f.number == 2 || f.number == 5 || f.number == 11 || f.number == 12;
  });
  if (file.input.empty() || file.output.empty()) fail("it must have one input and one output");
  return file;
}

}  // namespace

OnnxFile read_onnx(std::string_view bytes) {
  std::optional<OnnxFile> file;
  for_fields(bytes, "the model", [&](const Field& f) {
    if (f.number == 7) {
      if (file) fail("it holds two graphs");
      file = read_graph(f.bytes);
    }
    return f.number <= 8 && f.number != 5;
  });
  if (!file) fail("it holds no graph, or is cut short");
  return *std::move(file);
}

}  // namespace ensonify
