#include "ensonify/config/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>

#include "ensonify/config/paths.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"

/// Defined in programs that found ensonify with CMake (see cmake/ensonifyConfig.cmake.in), else null.
extern "C" __attribute__((weak)) const char* ensonify_package_data_folder();

namespace ensonify {
namespace fs = std::filesystem;
namespace {

/// The file that holds this code: a program, or a shared object that a program loaded.
fs::path own_file() {
  std::error_code no_throw;
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&library_folder), &here) != 0 && here.dli_fname != nullptr) {
    const fs::path named = here.dli_fname;
    if (named.is_absolute()) return fs::weakly_canonical(named, no_throw);
  }
  return fs::read_symlink("/proc/self/exe", no_throw);
}

/// share/ensonify beside or above the program: the prefix it is installed in, or its build folder.
std::optional<fs::path> data_near_program() {
  std::error_code no_throw;
  constexpr int levels = 6;
  fs::path folder = own_file().parent_path();
  for (int i = 0; i < levels && !folder.empty(); ++i, folder = folder.parent_path()) {
    if (fs::path data = folder / "share" / "ensonify"; fs::is_directory(data, no_throw)) return data;
  }
  return std::nullopt;
}

fs::path data_folder() {
  if (const char* data = std::getenv("ENSONIFY_DATA"); data != nullptr && *data != '\0') return data;
  if (ensonify_package_data_folder != nullptr) return ensonify_package_data_folder();
  return data_near_program().value_or(installed_data_folder);
}

/// What a user calls a file of the kind.
const char* word_for(const std::string& kind) {
  static const std::map<std::string, const char*> words{
      {"scenes", "scene"},         {"sensor_models", "sonar"},
      {"noise", "noise profile"},  {"generators", "recipe"},
      {"filters", "filter chain"}, {"filters/presets", "preset"},
      {"filters/models", "model"}, {"filters/tuning", "grid of parameters"}};
  const auto found = words.find(kind);
  return found == words.end() ? "file" : found->second;
}

}  // namespace

fs::path library_folder(const std::string& kind) { return data_folder() / kind / "library"; }

std::vector<std::string> library_names(const std::string& kind, const std::string& extension) {
  std::vector<std::string> names;
  std::error_code no_throw;
  for (const auto& entry : fs::directory_iterator(library_folder(kind), no_throw)) {
    if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path resolve_name(const std::string& kind, const std::string& path_or_name, const std::string& extension) {
  std::error_code no_throw;
  if (fs::is_regular_file(path_or_name, no_throw)) return path_or_name;
  const std::vector<std::string> names = library_names(kind, extension);
  if (std::find(names.begin(), names.end(), path_or_name) != names.end()) {
    return library_folder(kind) / (path_or_name + extension);
  }
  const std::string nearest = nearest_word(path_or_name, names);
  throw ConfigError(fmt::format("{}: no such file and no bundled {}; {}", path_or_name, word_for(kind),
                                names.empty()     ? "none is bundled"
                                : nearest.empty() ? fmt::format("there are {}", fmt::join(names, ", "))
                                                  : fmt::format("did you mean '{}'?", nearest)));
}

Reader open_config(const std::string& kind, const ConfigSource& source) {
  if (const auto* text = std::get_if<ConfigText>(&source)) return Reader::from_text(text->yaml, text->name);
  return Reader::from_file(resolve_name(kind, std::get<std::string>(source)));
}

std::string resolve_beside(const Reader& reader, std::string_view key, const std::string& kind,
                           const std::string& word) {
  std::error_code no_throw;
  const fs::path path = reader.folder() / word;
  if (fs::is_regular_file(path, no_throw)) return path.string();
  try {
    resolve_name(kind, word);
  } catch (const ConfigError& e) {
    reader.fail(key, e.what());
  }
  return word;
}

}  // namespace ensonify
