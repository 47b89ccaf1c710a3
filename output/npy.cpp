#include "ensonify/output/npy.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr std::string_view magic("\x93NUMPY", 6);

/// Bytes of one element; 0 for a type that this reader does not take.
std::size_t element_bytes(std::string_view descr) {
  if (descr.size() < 3 || descr.size() > 12) return 0;
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(descr.data() + 2, descr.data() + descr.size(), count);
  if (error != std::errc() || end != descr.data() + descr.size() || count == 0 || count > (1U << 20)) return 0;
  const char order = descr[0];
  const char kind = descr[1];
  if (kind == 'U') return order == '<' ? 4 * count : 0;
  if (std::string_view("uifb").find(kind) == std::string_view::npos || count > 8) return 0;
  return order == '<' || count == 1 ? count : 0;
}

/// The text after `key` in a header such as {'descr': '<f8', 'fortran_order': False, 'shape': (3,), }.
std::string_view after(std::string_view header, std::string_view key, const std::string& name) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) throw DataError(fmt::format("{}: the .npy header lacks {}", name, key));
  header.remove_prefix(at + key.size());
  const std::size_t value = header.find_first_not_of(": ");
  return value == std::string_view::npos ? std::string_view() : header.substr(value);
}

std::vector<std::size_t> parse_shape(std::string_view text, const std::string& name) {
  const auto broken = [&] { return DataError(fmt::format("{}: the .npy header has a broken shape", name)); };
  if (text.empty() || text[0] != '(') throw broken();
  text = text.substr(1, text.find(')') - 1);
  std::vector<std::size_t> shape;
  while (text.find_first_not_of(", ") != std::string_view::npos) {
    text.remove_prefix(text.find_first_not_of(", "));
    std::size_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || shape.size() == 8) throw broken();
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    shape.push_back(n);
  }
  return shape;
}

}  // namespace

NpyArray npy_text(std::string_view ascii) {
  NpyArray array{.descr = fmt::format("<U{}", ascii.empty() ? 1 : ascii.size()), .shape = {}, .bytes = {}};
  for (const char c : ascii) array.bytes.append({c, '\0', '\0', '\0'});
  if (ascii.empty()) array.bytes.assign(4, '\0');
  return array;
}

std::string to_npy(const NpyArray& array) {
  std::string shape;
  for (const std::size_t n : array.shape) shape += fmt::format("{}, ", n);
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  if (array.shape.size() == 1) shape.resize(shape.size() - 1);
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", array.descr, shape);
  const std::size_t before_data = magic.size() + 4 + header.size() + 1;
  header.append((64 - before_data % 64) % 64, ' ');  // data starts at a multiple of 64
  header += '\n';

  std::string file(magic);
  file += '\x01';
  file += '\0';
  file += static_cast<char>(header.size() & 0xFF);
  file += static_cast<char>(header.size() >> 8);
  file += header;
  file += array.bytes;
  return file;
}

NpyArray from_npy(std::string_view file, const std::string& name) {
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(file[i])); };
  if (file.size() < 12 || file.substr(0, magic.size()) != magic) {
    throw DataError(fmt::format("{}: not a .npy array", name));
  }
  const std::size_t version = byte(6);
  if (version < 1 || version > 3) throw DataError(fmt::format("{}: .npy format {} is unknown", name, version));
  const std::size_t start = version == 1 ? 10 : 12;
  const std::size_t length = byte(8) + 256 * byte(9) + (version == 1 ? 0 : 65536 * byte(10) + 16777216 * byte(11));
  if (length > file.size() - start) throw DataError(fmt::format("{}: the .npy header is cut off", name));
  const std::string_view header = file.substr(start, length);

  NpyArray array;
  const std::string_view descr = after(header, "'descr'", name);
  const std::size_t quote = descr.find('\'', 1);
  if (descr.empty() || descr[0] != '\'' || quote == std::string_view::npos) {
    throw DataError(fmt::format("{}: structured arrays and objects are not read", name));
  }
  array.descr = descr.substr(1, quote - 1);
  if (after(header, "'fortran_order'", name).substr(0, 5) != "False") {
    throw DataError(fmt::format("{}: the array is in Fortran order; save it with numpy.ascontiguousarray", name));
  }
  array.shape = parse_shape(after(header, "'shape'", name), name);

  const std::size_t element = element_bytes(array.descr);
  if (element == 0) throw DataError(fmt::format("{}: arrays of type '{}' are not read", name, array.descr));
  const std::string_view data = file.substr(start + length);
  std::size_t expected = element;
  for (const std::size_t n : array.shape) {
    if (n != 0 && expected > std::numeric_limits<std::size_t>::max() / n) {
      throw DataError(fmt::format("{}: the shape is too large", name));
    }
    expected *= n;
  }
  if (data.size() != expected) {
    throw DataError(fmt::format("{}: {} bytes of data, the shape says {}", name, data.size(), expected));
  }
  array.bytes = data;
  return array;
}

void expect_descr(const NpyArray& array, std::string_view descr, const std::string& name) {
  if (array.descr != descr) {
    throw DataError(fmt::format("{}: the type is '{}', it must be '{}'", name, array.descr, descr));
  }
}

}  // namespace ensonify
