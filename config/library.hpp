#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ensonify {

/// Where bundled YAML lives: $ENSONIFY_DATA; else the package that the program was built with (find_package); else
/// share/ensonify beside or above the program; else where the build was to be installed.
/// `kind` is scenes, sensor_models, noise or generators; the files are in <data>/<kind>/library/*.yaml.
std::filesystem::path library_folder(const std::string& kind);

/// Names (without .yaml) of the bundled files of a kind, sorted.
std::vector<std::string> library_names(const std::string& kind);

/// A path is taken as it is, a bundled name found in the library; else ConfigError naming the nearest name.
std::filesystem::path resolve_name(const std::string& kind, const std::string& path_or_name);

}  // namespace ensonify
