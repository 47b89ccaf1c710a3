#pragma once

#include <string>

namespace ensonify {

/// A text as one field of a CSV line, in quotes where it needs them (RFC 4180): names of chains are free.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace ensonify
