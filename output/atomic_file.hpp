#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "ensonify/core/error.hpp"

namespace ensonify {

/// The disk does not take what is written: full, read-only, gone. Whatever is written next will fare no better.
class DiskError : public DataError {
 public:
  using DataError::DataError;
};

/// "path: can not be written: reason; cure"
DiskError disk_error(const std::filesystem::path& path, const std::string& reason);

/// Calls write(temporary) with a name beside `path`, then renames it to `path`: readers see the old file or the whole
/// new one. The temporary is removed where write throws. Makes missing folders. Throws DiskError, also where `path` is
/// there and no regular file: a device or a pipe must not be replaced by a file.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same for bytes in memory.
void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

/// Writes a file that must not be there yet; false, and nothing changed, where it is. Of several processes that try,
/// one succeeds.
bool write_new_file(const std::filesystem::path& path, std::string_view text);

/// The name that a file has while it is being written: says which process of which machine writes it.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// Removes the temporaries below a folder whose processes were killed: those of this machine that run no more.
/// Not while other threads of this process write there.
void remove_abandoned(const std::filesystem::path& folder);
/// The same for those in the folder itself, not below.
void remove_abandoned_beside(const std::filesystem::path& folder);

/// A whole file. Throws DataError where it is missing, no regular file, unreadable, or larger than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 32);
std::string read_text(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{1} << 32);

}  // namespace ensonify
