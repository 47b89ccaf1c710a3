#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "ensonify/scenes/mesh_text.hpp"
#include "ensonify/scenes/node_graph.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_nesting = 64;
constexpr std::size_t max_stride = 252;
constexpr std::size_t max_node_index = 10'000'000;

/// An open object or array of the JSON text.
struct Level {
  bool array = false;
  std::size_t index = 0;  ///< of the current element of an array
  std::string_view key;   ///< current key of an object
};

/// Whether a number at this place is nodes[index].children[...].
std::optional<std::size_t> parent_node(const std::vector<Level>& levels) {
  const bool matches = levels.size() == 4 && levels[0].key == "nodes" && levels[1].array &&
                       levels[2].key == "children" && levels[3].array;
  return matches ? std::optional(levels[1].index) : std::nullopt;
}

/// End of the string that starts at `i` (a quote); npos if it does not end.
std::size_t string_end(std::string_view json, std::size_t i) {
  for (++i; i < json.size(); ++i) {
    if (json[i] == '\\') {
      ++i;
    } else if (json[i] == '"') {
      return i;
    }
  }
  return std::string_view::npos;
}

std::string json_fault(std::string_view json) {
  std::vector<Level> levels;
  std::vector<std::vector<std::size_t>> children;
  bool opened = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') {
      const std::size_t end = string_end(json, i);
      if (end == std::string_view::npos) return "the file is cut short";
      const std::string_view word = json.substr(i + 1, end - i - 1);
      if (!levels.empty() && !levels.back().array) {
        const std::size_t after = json.find_first_not_of(" \t\r\n", end + 1);
        if (after != std::string_view::npos && json[after] == ':') {
          if (word.find('\\') != std::string_view::npos) return "a key is written with escapes";
          levels.back().key = word;
        }
      }
      i = end;
    } else if (c == '{' || c == '[') {
      opened = true;
      levels.push_back({c == '[', 0, {}});
      if (levels.size() > max_nesting) return "its text nests more than 64 deep";
    } else if (c == '}' || c == ']') {
      if (levels.empty()) return "its brackets do not match";
      levels.pop_back();
    } else if (c == ',') {
      if (!levels.empty()) ++levels.back().index;
    } else if (c >= '0' && c <= '9') {
      std::size_t number = 0;
      const auto [rest, error] = std::from_chars(json.data() + i, json.data() + json.size(), number);
      if (!levels.empty() && levels.back().key == "byteStride" && number > max_stride) {
        return "a byteStride is larger than 252, the most that glTF allows";
      }
      if (const auto parent = parent_node(levels); parent && error == std::errc()) {
        if (*parent > max_node_index) return "it has too many nodes";
        if (children.size() <= *parent) children.resize(*parent + 1);
        children[*parent].push_back(number);
      }
      i = static_cast<std::size_t>(rest - json.data()) - 1;
    }
  }
  if (!opened || !levels.empty()) return "the file is cut short";
  // Nodes without children count as nodes too.
  std::size_t nodes = children.size();
  for (const auto& list : children) {
    for (const std::size_t child : list) {
      if (child <= max_node_index) nodes = std::max(nodes, child + 1);
    }
  }
  children.resize(nodes);
  return node_graph_fault(children);
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

}  // namespace

std::string gltf_fault(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return json_fault(bytes);
  constexpr std::size_t header = 20;  // magic, version, length, length and kind of the first chunk
  if (bytes.size() < header) return "the file is cut short";
  if (word_at(bytes, 4) != 2) return "it is no glTF of version 2";
  if (word_at(bytes, 8) > bytes.size()) return "the file is cut short";
  const std::size_t json_bytes = word_at(bytes, 12);
  if (bytes.substr(16, 4) != "JSON" || json_bytes > bytes.size() - header) return "its first part is no whole JSON";
  return json_fault(bytes.substr(header, json_bytes));
}

}  // namespace ensonify
