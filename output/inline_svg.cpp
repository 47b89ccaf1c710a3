#include "ensonify/output/inline_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <span>

#include "ensonify/output/html_text.hpp"
#include "ensonify/output/svg_tree.hpp"

namespace ensonify {
namespace {

using Names = std::set<std::string, std::less<>>;

constexpr std::array<std::string_view, 14> kept_elements{"svg",    "g",       "defs",    "path",     "rect",
                                                         "circle", "ellipse", "polygon", "polyline", "line",
                                                         "use",    "image",   "text",    "tspan"};

constexpr std::array<std::string_view, 30> kept_attributes{"viewBox",
                                                           "width",
                                                           "height",
                                                           "x",
                                                           "y",
                                                           "x1",
                                                           "y1",
                                                           "x2",
                                                           "y2",
                                                           "cx",
                                                           "cy",
                                                           "r",
                                                           "rx",
                                                           "ry",
                                                           "d",
                                                           "points",
                                                           "transform",
                                                           "stroke-width",
                                                           "stroke-dasharray",
                                                           "stroke-linecap",
                                                           "stroke-linejoin",
                                                           "fill-opacity",
                                                           "stroke-opacity",
                                                           "opacity",
                                                           "fill-rule",
                                                           "text-anchor",
                                                           "font-size",
                                                           "font-weight",
                                                           "dx",
                                                           "dy"};

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// The red, green and blue of "#rrggbb", "rgb(r, g, b)" or "black".
std::optional<std::array<unsigned, 3>> colour_of(std::string_view value) {
  if (value == "black") return {{0, 0, 0}};
  std::array<unsigned, 3> rgb{};
  const bool hex = value.starts_with("#") && value.size() == 7;
  if (!hex && !value.starts_with("rgb(")) return {};
  value.remove_prefix(hex ? 1 : 4);
  for (unsigned& part : rgb) {
    value.remove_prefix(std::min(value.find_first_not_of(" ,"), value.size()));
    const char* end = value.data() + (hex ? 2 : value.size());
    const auto [stop, error] = std::from_chars(value.data(), end, part, hex ? 16 : 10);
    if (error != std::errc() || part > 255) return {};
    value.remove_prefix(static_cast<std::size_t>(stop - value.data()));
  }
  return rgb;
}

std::string paint_of(const std::string& value) {
  const auto rgb = colour_of(value);
  if (!rgb) return value == "none" || value == "currentColor" ? value : "currentColor";
  if (*rgb == std::array<unsigned, 3>{0, 0, 0}) return "currentColor";
  const std::string digits = fmt::format("{:02x}{:02x}{:02x}", (*rgb)[0], (*rgb)[1], (*rgb)[2]);
  return fmt::format("var(--c-{0}, #{0})", digits);
}

bool is_background(const SvgNode& node, const SvgNode& root) {
  const auto rgb = colour_of(node.attribute("fill"));
  return node.name == "rect" && rgb && *rgb == std::array<unsigned, 3>{255, 255, 255} &&
         node.attribute("width") == root.attribute("width") && node.attribute("height") == root.attribute("height");
}

void tidy(SvgNode& node, const SvgNode& root, const std::string& prefix) {
  std::vector<std::pair<std::string, std::string>> attributes;
  for (auto& [key, value] : node.attributes) {
    const bool own_part = value.starts_with("#") && value.size() > 1;
    if (key == "xlink:href" || key == "href") {
      if (own_part) attributes.emplace_back("href", "#" + prefix + value.substr(1));
      if (node.name == "image" && value.starts_with("data:image/png;base64,")) attributes.emplace_back("href", value);
    } else if (key == "id") {
      attributes.emplace_back(key, prefix + value);
    } else if (key == "fill" || key == "stroke" || key == "color") {
      attributes.emplace_back(key, paint_of(value));
    } else if (is_one_of(kept_attributes, key)) {
      attributes.emplace_back(key, std::move(value));
    }
  }
  const bool holds_text = node.name == "text" || node.name == "tspan";
  std::erase_if(node.children, [&](const SvgNode& child) {
    return child.name.empty() ? !holds_text : !is_one_of(kept_elements, child.name) || is_background(child, root);
  });
  node.attributes = std::move(attributes);
  for (SvgNode& child : node.children) tidy(child, root, prefix);
  std::erase_if(node.children, [](const SvgNode& child) { return child.name == "g" && child.children.empty(); });
}

void find_used(const SvgNode& node, Names& used) {
  const std::string href = node.attribute("href");
  if (href.starts_with("#")) used.insert(href.substr(1));
  for (const SvgNode& child : node.children) find_used(child, used);
}

/// Ids that nothing asks for, and definitions without one.
void drop_unused(SvgNode& node, const Names& used) {
  std::erase_if(node.attributes, [&](const auto& a) { return a.first == "id" && !used.contains(a.second); });
  for (SvgNode& child : node.children) drop_unused(child, used);
  std::erase_if(node.children, [](const SvgNode& child) { return child.name == "defs" && child.children.empty(); });
  if (node.name != "defs") return;
  std::erase_if(node.children, [](const SvgNode& child) { return child.attribute("id").empty(); });
}

std::size_t size_of(const SvgNode& node) {
  std::size_t size = 1;
  for (const SvgNode& child : node.children) size += size_of(child);
  return size;
}

}  // namespace

std::string inline_svg(std::string_view svg, const std::string& prefix, const std::string& alt) {
  SvgNode root = read_svg(svg);
  const SvgNode before{root.name, "", root.attributes, {}};
  tidy(root, before, prefix);
  for (std::size_t size = 0; size != size_of(root);) {  // a definition may be all that used another
    size = size_of(root);
    Names used;
    find_used(root, used);
    drop_unused(root, used);
  }
  root.attributes.emplace_back("role", "img");
  root.attributes.emplace_back("aria-label", escaped(alt));
  std::string out;
  write_svg(root, out);
  return out;
}

}  // namespace ensonify
