#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace ensonify {

/// Calls write(temporary) with a name beside `path`, then renames it to `path`: readers see the old file or the whole
/// new one. The temporary is removed where write throws. Makes missing folders. Throws DataError.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes in memory.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

/// The name that a file has while it is being written: says which process of which machine writes it.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Removes the temporaries below a folder whose processes were killed: those of this machine that run no more.
/// Not while other threads of this process write there.
void remove_abandoned(const std::filesystem::path& folder);

/// A whole file. Throws DataError where it is missing, unreadable, or larger than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 32);
std::string read_text(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 32);

}  // namespace ensonify
