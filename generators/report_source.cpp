#include "ensonify/generators/report_source.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ensonify {
namespace {

using nlohmann::json;

/// The value at a path of keys as text; empty where there is none.
std::string text_at(const json& manifest, const char* path) {
  const json::json_pointer pointer(path);
  if (!manifest.contains(pointer)) return "";
  const json& value = manifest.at(pointer);
  return value.is_string() ? value.get<std::string>() : value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

ReportSource report_source(const Dataset& dataset) {
  const json manifest = json::parse(dataset.manifest);
  const std::string seed = text_at(manifest, "/seed");
  ReportSource source{fmt::format("Dataset {}, {}root hash {}…", dataset.name,
                                  seed.empty() ? "" : "seed " + seed + ", ", dataset.root_hash.substr(0, 12)),
                      {{"Dataset", fmt::format("{}: {}", dataset.name, dataset.title)},
                       {"Seed", seed},
                       {"Root hash", dataset.root_hash},
                       {"Sonar", text_at(manifest, "/sonar/name")},
                       {"Noise", text_at(manifest, "/noise/name")},
                       {"Frames", std::to_string(dataset.frames())},
                       {"Made with", "ensonify " + text_at(manifest, "/tool/version")},
                       {"Reported with", "ensonify " ENSONIFY_VERSION}}};
  std::erase_if(source.facts, [](const auto& fact) { return fact.second.empty() || fact.second == "ensonify "; });
  return source;
}

}  // namespace ensonify
