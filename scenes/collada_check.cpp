#include <algorithm>
#include <charconv>
#include <map>
#include <vector>

#include "ensonify/scenes/mesh_text.hpp"
#include "ensonify/scenes/node_graph.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_nesting = 400;
constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Value of an attribute inside a tag; empty where it has none.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == std::string_view::npos) continue;
    const std::size_t equals = tag.find_first_not_of(" \t\r\n", at + name.size());
    if (equals == std::string_view::npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_of("\"'", equals);
    if (quote == std::string_view::npos) return {};
    return tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1);
  }
  return {};
}

/// End of the tag that starts at `i`, past quoted values; npos if it does not end.
std::size_t tag_end(std::string_view xml, std::size_t i) {
  char quote = 0;
  for (; i < xml.size(); ++i) {
    if (quote != 0) {
      if (xml[i] == quote) quote = 0;
    } else if (xml[i] == '"' || xml[i] == '\'') {
      quote = xml[i];
    } else if (xml[i] == '>') {
      return i;
    }
  }
  return std::string_view::npos;
}

/// The nodes of the file: which contain or instance which.
struct NodeGraph {
  std::vector<std::vector<std::size_t>> children;
  std::multimap<std::string, std::size_t, std::less<>> named;
  std::vector<std::pair<std::size_t, std::string>> instances;  ///< node, and the name it refers to

  /// Adds what a tag says; returns the index if it is a node. `fault` says what can not be followed.
  std::size_t add(std::string_view tag, std::string_view word, std::size_t parent, std::string& fault) {
    if (word == "instance_node") {
      const std::string_view url = attribute(tag, "url");
      // An escaped reference could name a node behind the back of this check.
      if (url.find_first_of("&<>\"'\t\r\n") != std::string_view::npos) fault = "a node refers with escaped text";
      if (parent != none && url.size() > 1) instances.emplace_back(parent, url.substr(1));
      return none;
    }
    if (word != "node") return none;
    const std::size_t index = children.size();
    children.emplace_back();
    if (parent != none) children[parent].push_back(index);
    for (const char* key : {"id", "name", "sid"}) {
      const std::string_view value = attribute(tag, key);
      if (value.find("&#") != std::string_view::npos) fault = "a node is named with escaped text";
      if (!value.empty()) named.emplace(value, index);
    }
    return index;
  }

  std::string unfolding_fault() {
    constexpr std::size_t max_links = 10'000'000;
    std::size_t links = 0;
    for (const auto& [node, name] : instances) {
      const auto [first, last] = named.equal_range(name);
      for (auto it = first; it != last; ++it) {
        if (++links > max_links) return "its nodes refer to each other too often";
        children[node].push_back(it->second);
      }
    }
    return node_graph_fault(children);
  }
};

/// Arrays of numbers and the accessors that read them. assimp takes their counts on trust.
struct ArrayBook {
  struct Accessor {
    std::string source;
    std::size_t offset = 0, count = 0, stride = 1, width = 0;
  };
  std::map<std::string, std::size_t, std::less<>> lengths;
  std::vector<Accessor> accessors;
  bool in_accessor = false;

  void add(std::string_view tag, std::string_view word, std::size_t file_bytes, std::string& fault) {
    const auto whole = [&](const char* name, std::size_t fallback) {
      const std::string_view text = attribute(tag, name);
      if (text.empty() && tag.find(name) == std::string_view::npos) return fallback;
      std::size_t value = 0;
      const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || rest != text.data() + text.size() || value > file_bytes) {
        fault = "a count, stride or offset is no whole number, or larger than the file";
      }
      return value;
    };
    if (word == "/accessor") in_accessor = false;
    if (word == "param" && in_accessor) {
      accessors.back().width += attribute(tag, "type").find("4x4") == std::string_view::npos ? 1 : 16;
    }
    if (word == "input" || word == "polylist" || word == "triangles" || word == "polygons") {
      whole("count", 0);
      whole("offset", 0);
    }
    const std::string_view name = attribute(tag, word == "accessor" ? "source" : "id");
    if (word.ends_with("_array")) {
      const std::size_t length = whole("count", 0);
      if (name.find('&') != std::string_view::npos) fault = "an array is named with escaped text";
      const auto [entry, is_new] = lengths.try_emplace(std::string(name), length);
      if (!is_new) entry->second = std::min(entry->second, length);
    }
    if (word == "accessor" && name.starts_with('#')) {
      accessors.push_back({std::string(name.substr(1)), whole("offset", 0), whole("count", 0), whole("stride", 1), 0});
      in_accessor = !tag.ends_with('/');
    }
  }

  std::string reading_fault() const {
    for (const Accessor& a : accessors) {
      const auto array = lengths.find(a.source);
      if (array == lengths.end() || a.count == 0) continue;
      const std::size_t last = a.offset + (a.count - 1) * a.stride;
      if (last + std::max(a.stride, a.width) > array->second) return "an accessor reads beyond its array";
    }
    return {};
  }
};

/// Whether what follows the tag that ends at `end` is whole numbers and then another tag's end. assimp waits for ever
/// at anything else in a list of indices.
bool holds_indices(std::string_view xml, std::size_t end) {
  const std::size_t after = xml.find_first_not_of("0123456789+- \t\r\n", end + 1);
  return after != std::string_view::npos && xml.substr(after).starts_with("</");
}

}  // namespace

std::string collada_fault(std::string_view xml) {
  NodeGraph graph;
  ArrayBook arrays;
  std::vector<std::size_t> open;  // the node that each open element is in
  std::string fault;
  bool any = false;
  for (std::size_t i = xml.find('<'); i != std::string_view::npos; i = xml.find('<', i)) {
    const std::string_view rest = xml.substr(i);
    const std::string_view close = rest.starts_with("<!--")        ? "-->"
                                   : rest.starts_with("<![CDATA[") ? "]]>"
                                   : rest.starts_with("<?")        ? "?>"
                                                                   : "";
    if (rest.starts_with("<!DOCTYPE")) return "it has a document type, which is not read";
    const std::size_t end = close.empty() ? tag_end(xml, i) : xml.find(close, i);
    if (end == std::string_view::npos) return "the file is cut short";
    if (rest.starts_with("</")) {
      if (open.empty()) return "its elements do not match";
      open.pop_back();
      arrays.add(xml.substr(i + 1, end - i - 1), xml.substr(i + 1, end - i - 1), xml.size(), fault);
    } else if (close.empty()) {
      const std::string_view tag = xml.substr(i + 1, end - i - 1);
      const std::string_view word = tag.substr(0, tag.find_first_of(" \t\r\n/"));
      const std::size_t parent = open.empty() ? none : open.back();
      const std::size_t node = graph.add(tag, word, parent, fault);
      arrays.add(tag, word, xml.size(), fault);
      if ((word == "p" || word == "vcount") && !tag.ends_with('/') && !holds_indices(xml, end)) {
        fault = "a list of indices holds something else than whole numbers";
      }
      if (!fault.empty()) return fault;
      if (!tag.ends_with('/')) open.push_back(node == none ? parent : node);
      if (open.size() > max_nesting) return "its text nests more than 400 deep";
      any = true;
    }
    i = end;
  }
  if (!any || !open.empty()) return any ? "the file is cut short" : "it holds no XML";
  fault = arrays.reading_fault();
  return fault.empty() ? graph.unfolding_fault() : fault;
}

}  // namespace ensonify
