#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ensonify {

/// An element, or where `name` is empty a piece of text. Values and texts are as in the file: entities stay.
struct SvgNode {
  std::string name, text;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<SvgNode> children;

  /// Empty where there is no such attribute.
  std::string attribute(std::string_view key) const;
};

/// The svg element of a file; comments, declarations and processing instructions are passed over. Throws DataError
/// where tags or quotes are not closed, or more than 100 elements lie within each other.
SvgNode read_svg(std::string_view text);

void write_svg(const SvgNode& node, std::string& out);

}  // namespace ensonify
