#include "ensonify/output/npz.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

using Archive = std::unique_ptr<archive, int (*)(archive*)>;
using Entry = std::unique_ptr<archive_entry, void (*)(archive_entry*)>;

DataError broken(const std::filesystem::path& path, const std::string& why) {
  return DataError(fmt::format("can not read {}: {}; is it a whole .npz file?", path.string(), why));
}

std::string reason(archive* zip) {
  const char* text = archive_error_string(zip);
  return text ? text : "unknown error";
}

/// What the disk says; libarchive's own text is only "Write error".
DiskError write_error(const std::filesystem::path& path, archive* zip) {
  const int error = archive_errno(zip);
  return disk_error(path, error > 0 ? std::strerror(error) : reason(zip));
}

void write_entry(archive* zip, const std::filesystem::path& path, const std::string& name, const std::string& bytes) {
  const Entry entry(archive_entry_new(), archive_entry_free);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
  // Before 1980 in every time zone: zip's local time then is its least value everywhere.
  archive_entry_set_mtime(entry.get(), 0, 0);
  if (archive_write_header(zip, entry.get()) != ARCHIVE_OK ||
      archive_write_data(zip, bytes.data(), bytes.size()) != static_cast<la_ssize_t>(bytes.size())) {
    throw write_error(path, zip);
  }
}

std::string read_entry(archive* zip, const std::filesystem::path& path, const std::string& name,
                       std::size_t max_bytes) {
  std::string bytes;
  const void* block = nullptr;
  std::size_t size = 0;
  la_int64_t offset = 0;
  for (;;) {
    const int status = archive_read_data_block(zip, &block, &size, &offset);
    if (status == ARCHIVE_EOF) return bytes;
    if (status != ARCHIVE_OK) throw broken(path, reason(zip));
    if (static_cast<std::size_t>(offset) != bytes.size()) throw broken(path, "the data of " + name + " has gaps");
    if (size > max_bytes - bytes.size()) {
      throw broken(path, fmt::format("{} unpacks to more than {} bytes", name, max_bytes));
    }
    bytes.append(static_cast<const char*>(block), size);
  }
}

}  // namespace

void write_npz(const std::filesystem::path& path, const std::map<std::string, NpyArray>& arrays) {
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    const Archive zip(archive_write_new(), archive_write_free);
    archive_write_set_format_zip(zip.get());
    archive_write_set_bytes_per_block(zip.get(), 1 << 20);
    archive_write_set_bytes_in_last_block(zip.get(), 1);  // no padding
    // Level 1: grids are mostly runs; higher levels cost several times as long for a few per cent.
    if (archive_write_set_options(zip.get(), "zip:compression=deflate,zip:compression-level=1") != ARCHIVE_OK ||
        archive_write_open_filename(zip.get(), temporary.c_str()) != ARCHIVE_OK) {
      throw write_error(path, zip.get());
    }
    for (const auto& [name, array] : arrays) write_entry(zip.get(), path, name + ".npy", to_npy(array));
    if (archive_write_close(zip.get()) != ARCHIVE_OK) throw write_error(path, zip.get());
  });
}

std::map<std::string, NpyArray> read_npz(const std::filesystem::path& path, std::size_t max_array_bytes) {
  std::error_code no_throw;
  if (!std::filesystem::is_regular_file(path, no_throw)) throw broken(path, "no such file");
  const Archive zip(archive_read_new(), archive_read_free);
  archive_read_support_format_zip_seekable(zip.get());
  if (archive_read_open_filename(zip.get(), path.c_str(), 1 << 20) != ARCHIVE_OK) {
    throw broken(path, reason(zip.get()));
  }
  std::map<std::string, NpyArray> arrays;
  archive_entry* entry = nullptr;
  for (;;) {
    const int status = archive_read_next_header(zip.get(), &entry);
    if (status == ARCHIVE_EOF) return arrays;
    if (status != ARCHIVE_OK) throw broken(path, reason(zip.get()));
    const char* raw_name = archive_entry_pathname(entry);
    std::string name = raw_name ? raw_name : "";
    if (!name.ends_with(".npy")) continue;
    if (arrays.size() == 256) throw broken(path, "more than 256 arrays");
    name.resize(name.size() - 4);
    const std::string bytes = read_entry(zip.get(), path, name, max_array_bytes);
    arrays[name] = from_npy(bytes, path.string() + ": " + name);
  }
}

}  // namespace ensonify
