#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace ensonify {

/// Parses JSON that anyone may have written: text that nests deeper than 64 is refused, since all that walks the values
/// later recurses. Throws DataError naming `file`.
nlohmann::json parse_json(const std::string& text, const std::filesystem::path& file);

/// As text that ends in a newline; bytes that are no UTF-8 (file names may hold them) become U+FFFD.
std::string json_text(const nlohmann::json& value);

/// The manifest as text, with the SHA-256 of that text (its own 64 digits taken as 0) under `manifest_sha256`.
std::string sealed_manifest(nlohmann::json manifest);

/// Whether the text is as sealed_manifest() gave it, to the byte.
bool seal_holds(const std::string& text);

}  // namespace ensonify
