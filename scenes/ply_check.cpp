#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>
#include <vector>

#include "ensonify/scenes/mesh_text.hpp"

namespace ensonify {
namespace {

struct Property {
  std::size_t list_count_bytes = 0;  ///< 0: no list
  bool list_count_signed = false;
  std::size_t bytes = 0;
};

struct Element {
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
  std::size_t body = 0;
};

std::size_t bytes_of(const std::string& type) {
  for (const char* t : {"char", "uchar", "int8", "uint8"}) {
    if (type == t) return 1;
  }
  for (const char* t : {"short", "ushort", "int16", "uint16"}) {
    if (type == t) return 2;
  }
  for (const char* t : {"int", "uint", "float", "int32", "uint32", "float32"}) {
    if (type == t) return 4;
  }
  return type == "double" || type == "float64" ? 8 : 0;
}

std::string read_header(std::string_view bytes, Header& header) {
  // The last line must be just this: a parser that does not see it there reads on into the body.
  // assimp's time grows with the square of the lines before it.
  const std::string_view start = bytes.substr(0, 1 << 18);
  const std::size_t end = std::min(start.find("\nend_header\n"), start.find("\nend_header\r\n"));
  if (!bytes.starts_with("ply") || end == std::string_view::npos)
    return "it has no PLY header within its first 256 KiB";
  header.body = bytes.find('\n', end + 1) + 1;
  std::set<std::string> names;
  std::istringstream lines{std::string(bytes.substr(0, end))};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word;
    if (word == "format") words >> header.format;
    if (word == "element") {
      std::string count;
      words >> name >> count;
      const bool whole = !count.empty() && count.size() < 19 && count.find_first_not_of("0123456789") == count.npos;
      if (!whole) return "an element has no whole count";
      if (!names.insert(name).second) return "an element is given twice";
      header.elements.push_back({std::stoull(count), {}});
    } else if (word != "property" && word != "format" && word != "comment" && word != "obj_info" && word != "ply" &&
               !word.empty()) {
      return "its header has an unknown line";
    }
    if (word != "property") continue;
    if (header.elements.empty()) return "a property stands before its element";
    Property property;
    words >> type;
    if (type == "list") {
      std::string count_type;
      words >> count_type >> type;
      property.list_count_bytes = bytes_of(count_type);
      property.list_count_signed = !count_type.starts_with('u');
      if (property.list_count_bytes == 0 || property.list_count_bytes == 8 || count_type.starts_with("float")) {
        return "a list has no whole count";
      }
    }
    property.bytes = bytes_of(type);
    if (property.bytes == 0) return "a property has an unknown type";
    header.elements.back().properties.push_back(property);
  }
  for (const Element& element : header.elements) {
    if (element.properties.empty() && element.count > 0) return "an element has no properties";
  }
  return {};
}

/// Walks the body of a text file word by word.
std::string text_body_fault(std::string_view body, const Header& header) {
  std::size_t at = 0;
  const auto next = [&] {
    const std::size_t start = body.find_first_not_of(" \t\r\n", at);
    if (start == std::string_view::npos) return std::string_view{};
    at = std::min(body.find_first_of(" \t\r\n", start), body.size());
    return body.substr(start, at - start);
  };
  for (const Element& element : header.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const std::string_view word = next();
        if (word.empty()) return "the file is cut short";
        const double items = property.list_count_bytes > 0 ? std::strtod(std::string(word).c_str(), nullptr) : 0;
        if (!(items >= 0) || items > static_cast<double>(body.size())) return "a list is longer than the file";
        for (double k = 0; k < items; ++k) {
          if (next().empty()) return "the file is cut short";
        }
      }
    }
  }
  return {};
}

std::uint64_t unsigned_at(const char* bytes, std::size_t size, bool big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = big_endian ? i : size - 1 - i;
    value = value << 8 | static_cast<unsigned char>(bytes[from]);
  }
  return value;
}

std::string binary_body_fault(std::string_view body, const Header& header, bool big_endian) {
  std::size_t at = 0;
  for (const Element& element : header.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        std::size_t need = property.bytes;
        if (property.list_count_bytes > 0) {
          if (body.size() - at < property.list_count_bytes) return "the file is cut short";
          const std::uint64_t items = unsigned_at(body.data() + at, property.list_count_bytes, big_endian);
          if (property.list_count_signed && items >> (8 * property.list_count_bytes - 1) != 0) {
            return "a list has a negative length";
          }
          at += property.list_count_bytes;
          need = static_cast<std::size_t>(items) * property.bytes;
        }
        if (body.size() - at < need) return "the file is cut short";
        at += need;
      }
    }
  }
  return {};
}

}  // namespace

std::string ply_fault(std::string_view bytes) {
  Header header;
  if (std::string fault = read_header(bytes, header); !fault.empty()) return fault;
  const std::string_view body = bytes.substr(header.body);
  if (header.format == "ascii") return text_body_fault(body, header);
  if (header.format != "binary_little_endian" && header.format != "binary_big_endian") {
    return "its format is neither ascii nor binary";
  }
  return binary_body_fault(body, header, header.format == "binary_big_endian");
}

}  // namespace ensonify
