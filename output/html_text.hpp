#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace ensonify {

/// Text as it may stand between tags and within quotes of attributes: & < > " ' escaped, control characters dropped,
/// bytes that are no UTF-8 shown as U+FFFD.
std::string escaped(std::string_view text);

/// A word for ids and anchors: small letters, digits and single hyphens; "x" where nothing is left.
std::string anchor_of(std::string_view text);

/// "data:image/png;base64,..."
std::string png_uri(std::span<const std::uint8_t> png);

}  // namespace ensonify
