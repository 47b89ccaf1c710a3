#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ensonify {

/// Whether a name may stand for a file below a folder: relative, without `..`, `.`, empty parts or control characters.
bool stays_inside(const std::string& name);

/// SHA-256 by name of file, from a list as `sha256sum` writes it. Throws DataError where a line is none, names a file
/// outside of the list's folder, or names one twice.
std::map<std::string, std::string> read_file_list(const std::filesystem::path& list);

/// Regular files and links below a folder that `known` does not say are its own, by name, sorted; left out are hidden
/// ones at the top (.git, .ensonify) and the folder stats/, where descriptions of a dataset go.
std::vector<std::string> strangers(const std::filesystem::path& folder,
                                   const std::map<std::string, std::string>& known);

}  // namespace ensonify
