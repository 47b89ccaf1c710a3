#include "ensonify/config/library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "ensonify/config/paths.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"

namespace ensonify {
namespace fs = std::filesystem;

fs::path library_folder(const std::string& kind) {
  std::error_code no_throw;
  if (const char* data = std::getenv("ENSONIFY_DATA"); data != nullptr && *data != '\0') {
    return fs::path(data) / kind / "library";
  }
  const fs::path source = fs::path(source_data_folder) / kind / "library";
  const fs::path installed = fs::path(installed_data_folder) / kind / "library";
  return fs::is_directory(source, no_throw) ? source : installed;
}

std::vector<std::string> library_names(const std::string& kind) {
  std::vector<std::string> names;
  std::error_code no_throw;
  for (const auto& entry : fs::directory_iterator(library_folder(kind), no_throw)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path resolve_name(const std::string& kind, const std::string& path_or_name) {
  std::error_code no_throw;
  if (fs::is_regular_file(path_or_name, no_throw)) return path_or_name;
  const std::vector<std::string> names = library_names(kind);
  if (std::find(names.begin(), names.end(), path_or_name) != names.end()) {
    return library_folder(kind) / (path_or_name + ".yaml");
  }
  const std::string nearest = nearest_word(path_or_name, names);
  throw ConfigError(fmt::format("{}: no such file and no bundled name of {}; {}", path_or_name, kind,
                                nearest.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                                : fmt::format("did you mean '{}'?", nearest)));
}

}  // namespace ensonify
