#include "ensonify/output/svg_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr std::string_view blanks = " \t\r\n";

/// Takes text from its front.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }
  bool starts_with(std::string_view start) const { return rest_.starts_with(start); }

  bool take(std::string_view start) {
    if (!rest_.starts_with(start)) return false;
    rest_.remove_prefix(start.size());
    return true;
  }

  /// Up to `end`, which is taken too.
  std::string_view take_through(std::string_view end) {
    const std::string_view taken = take_until(end);
    rest_.remove_prefix(end.size());
    return taken;
  }

  std::string_view take_until(std::string_view end) {
    const std::size_t at = rest_.find(end);
    if (at == rest_.npos) throw DataError(fmt::format("broken SVG: no '{}'", end));
    const std::string_view taken = rest_.substr(0, at);
    rest_.remove_prefix(at);
    return taken;
  }

  std::string_view take_word() {
    const std::string_view taken = rest_.substr(0, rest_.find_first_of(" \t\r\n=/><'\""));
    if (taken.empty()) throw DataError("broken SVG: a name is missing");
    rest_.remove_prefix(taken.size());
    return taken;
  }

  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size())); }

 private:
  std::string_view rest_;
};

/// Comments, declarations, processing instructions.
bool skip_aside(Scanner& scanner) {
  if (scanner.take("<!--")) return scanner.take_through("-->"), true;
  if (scanner.take("<?")) return scanner.take_through("?>"), true;
  if (scanner.take("<!")) return scanner.take_through(">"), true;
  return false;
}

SvgNode read_element(Scanner& scanner, int depth);

void read_children(Scanner& scanner, SvgNode& parent, int depth) {
  while (!scanner.take("</")) {
    if (skip_aside(scanner)) continue;
    if (scanner.starts_with("<")) {
      parent.children.push_back(read_element(scanner, depth + 1));
    } else {
      parent.children.push_back({"", std::string(scanner.take_until("<")), {}, {}});
    }
  }
  if (scanner.take_word() != parent.name) throw DataError("broken SVG: tags are not closed in order");
  scanner.take_through(">");
}

SvgNode read_element(Scanner& scanner, int depth) {
  if (depth > 100) throw DataError("broken SVG: too many elements within each other");
  if (!scanner.take("<")) throw DataError("broken SVG: an element is missing");
  SvgNode node{std::string(scanner.take_word()), "", {}, {}};
  for (;;) {
    scanner.skip_blanks();
    if (scanner.take("/>")) return node;
    if (scanner.take(">")) break;
    std::string key(scanner.take_word());
    scanner.skip_blanks();
    if (!scanner.take("=")) throw DataError("broken SVG: an attribute without a value");
    scanner.skip_blanks();
    const char* quote = scanner.starts_with("'") ? "'" : "\"";
    if (!scanner.take(quote)) throw DataError("broken SVG: a value without quotes");
    node.attributes.emplace_back(std::move(key), std::string(scanner.take_through(quote)));
  }
  read_children(scanner, node, depth);
  return node;
}

/// Quotes of the other kind and tags could end the value early.
std::string within_quotes(const std::string& value) {
  std::string result;
  for (const char c : value) {
    if (c == '"') {
      result += "&quot;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

std::string SvgNode::attribute(std::string_view key) const {
  const auto found = std::ranges::find_if(attributes, [&](const auto& a) { return a.first == key; });
  return found == attributes.end() ? std::string() : found->second;
}

SvgNode read_svg(std::string_view text) {
  Scanner scanner(text);
  do {
    scanner.skip_blanks();
  } while (skip_aside(scanner));
  SvgNode root = read_element(scanner, 0);
  if (root.name != "svg") throw DataError("broken SVG: no svg element");
  return root;
}

void write_svg(const SvgNode& node, std::string& out) {
  if (node.name.empty()) {
    for (const char c : node.text) out += c == '>' ? "&gt;" : std::string(1, c);
    return;
  }
  out += "<" + node.name;
  for (const auto& [key, value] : node.attributes) out += fmt::format(" {}=\"{}\"", key, within_quotes(value));
  out += ">";
  for (const SvgNode& child : node.children) write_svg(child, out);
  out += "</" + node.name + ">";
}

}  // namespace ensonify
