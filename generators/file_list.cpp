#include "ensonify/generators/file_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace fs = std::filesystem;

bool stays_inside(const std::string& name) {
  const bool printable = std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= ' ' && c != 127; });
  const fs::path path = name;
  return printable && !name.empty() && name.back() != '/' && path.is_relative() &&
         path.lexically_normal().native() == name && *path.begin() != "..";
}

std::map<std::string, std::string> read_file_list(const fs::path& list) {
  constexpr std::size_t digits = 64;
  const std::string text = read_text(list);
  std::map<std::string, std::string> files;
  int number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    ++number;
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const auto fail = [&](const char* rule) { throw DataError(fmt::format("{}:{}: {}", list.string(), number, rule)); };
    const bool shaped = line.size() > digits + 2 && line.substr(digits, 2) == "  " &&
                        line.substr(0, digits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
    if (!shaped) fail("is no line '<SHA-256>  <file>'");
    const std::string name(line.substr(digits + 2));
    if (!stays_inside(name)) fail("names a file outside of the dataset");
    if (!files.emplace(name, line.substr(0, digits)).second) fail("names a file a second time");
  }
  return files;
}

std::vector<std::string> strangers(const fs::path& folder, const std::map<std::string, std::string>& known) {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().lexically_relative(folder).generic_string();
    const bool apart = entry.depth() == 0 && (name.starts_with('.') || name == "stats");
    if (apart) {
      entry.disable_recursion_pending();
    } else if (!entry->is_directory(error) && !known.contains(name)) {
      found.push_back(name);
    }
  }
  if (error) throw DataError(fmt::format("{}: can not be listed: {}", folder.string(), error.message()));
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace ensonify
