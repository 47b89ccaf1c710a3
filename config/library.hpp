#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "ensonify/config/reader.hpp"

namespace ensonify {

/// Where bundled YAML lives: $ENSONIFY_DATA; else the package that the program was built with (find_package); else
/// share/ensonify beside or above the program; else where the build was to be installed.
/// `kind` is scenes, sensor_models, noise or generators; the files are in <data>/<kind>/library/*.yaml.
std::filesystem::path library_folder(const std::string& kind);

/// Names (without extension) of the bundled files of a kind, sorted.
std::vector<std::string> library_names(const std::string& kind, const std::string& extension = ".yaml");

/// A path is taken as it is, a bundled name found in the library; else ConfigError naming the nearest name.
std::filesystem::path resolve_name(const std::string& kind, const std::string& path_or_name,
                                   const std::string& extension = ".yaml");

/// A configuration in memory: YAML, and so JSON too. `name` stands in messages where a path would; relative paths in it
/// start from the working folder.
struct ConfigText {
  std::string yaml, name;
};

/// Where a configuration comes from: a path or a bundled name, or a text.
using ConfigSource = std::variant<std::string, ConfigText>;

/// Throws ConfigError as resolve_name() and Reader do.
Reader open_config(const std::string& kind, const ConfigSource& source);

/// What a configuration means by `word` under `key`: a file beside it where there is one, else the word as it is, a
/// path or a bundled name. Throws ConfigError at the key where it is neither.
std::string resolve_beside(const Reader& reader, std::string_view key, const std::string& kind,
                           const std::string& word);

}  // namespace ensonify
