#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "ensonify/output/contact_sheet.hpp"

/// What a stage found, kept in a file, so that a run that was stopped does not do it again.
namespace ensonify {

/// Everything that a finding follows from, as one line.
using FindingKey = std::string;

/// The text that was kept under this key; none where the file is missing, or kept under another key.
std::optional<std::string> find_kept(const std::filesystem::path& file, const FindingKey& key);
void keep(const std::filesystem::path& file, const FindingKey& key, std::string_view text);

/// What was kept, else what `make` gives, which is then kept.
std::string kept_or(const std::filesystem::path& file, const FindingKey& key, const std::function<std::string()>& make);

/// A sheet as PNG files and a list of them in a folder. The list comes last.
void keep_sheet(const std::filesystem::path& folder, const FindingKey& key, const ContactSheet& sheet);
/// None where the folder holds none under this key. Throws DataError where a picture is missing or broken.
std::optional<ContactSheet> find_kept_sheet(const std::filesystem::path& folder, const FindingKey& key);

}  // namespace ensonify
