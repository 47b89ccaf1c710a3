#include "ensonify/generators/json_text.hpp"

#include <fmt/format.h>

#include <string_view>

#include "ensonify/core/error.hpp"
#include "ensonify/output/sha256.hpp"

namespace ensonify {
namespace {

using nlohmann::json;

constexpr int max_depth = 64;
constexpr std::size_t digits = 64;
constexpr const char* seal_key = "manifest_sha256";

/// Where the digits of the seal begin; npos where there are none.
std::size_t seal_at(std::string_view text) {
  const std::string before = fmt::format("\"{}\": \"", seal_key);
  const std::size_t at = text.find(before);
  const bool whole = at != std::string_view::npos && at + before.size() + digits <= text.size();
  return whole ? at + before.size() : std::string_view::npos;
}

}  // namespace

json parse_json(const std::string& text, const std::filesystem::path& file) {
  const auto shallow = [&](int depth, json::parse_event_t, const json&) {
    if (depth > max_depth) throw DataError(fmt::format("{}: nests more than {} deep", file.string(), max_depth));
    return true;
  };
  try {
    return json::parse(text, shallow);
  } catch (const json::exception& e) {
    throw DataError(fmt::format("{}: no whole JSON: {}", file.string(), e.what()));
  }
}

std::string json_text(const json& value) { return value.dump(1, ' ', false, json::error_handler_t::replace) + "\n"; }

std::string sealed_manifest(json manifest) {
  manifest[seal_key] = std::string(digits, '0');
  std::string text = json_text(manifest);
  return text.replace(seal_at(text), digits, Sha256().add(std::string_view(text)).hex());
}

bool seal_holds(const std::string& text) {
  const std::size_t at = seal_at(text);
  if (at == std::string::npos) return false;
  std::string unsealed = text;
  unsealed.replace(at, digits, digits, '0');
  return Sha256().add(std::string_view(unsealed)).hex() == text.substr(at, digits);
}

}  // namespace ensonify
