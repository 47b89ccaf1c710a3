#include "ensonify/output/tar_shard.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <cstring>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
constexpr la_int64_t max_member_bytes = la_int64_t{1} << 32;

[[noreturn]] void fail(const fs::path& path, archive* a) {
  const char* reason = archive_error_string(a);
  throw DataError(fmt::format("{}: {}", path.string(), reason != nullptr ? reason : "tar error"));
}

DiskError write_error(const fs::path& path, archive* a) {
  const int error = archive_errno(a);
  return disk_error(path, error > 0 ? std::strerror(error) : "tar error");
}

}  // namespace

TarShard::TarShard(fs::path path)
    : path_(std::move(path)), temporary_(temporary_name(path_)), archive_(archive_write_new()) {
  std::error_code error;
  fs::create_directories(path_.parent_path(), error);
  archive_write_set_format_ustar(archive_);
  if (archive_write_open_filename(archive_, temporary_.c_str()) != ARCHIVE_OK) {
    const DiskError reason = write_error(path_, archive_);
    archive_write_free(archive_);
    throw reason;
  }
}

TarShard::~TarShard() {
  if (archive_ == nullptr) return;
  archive_write_free(archive_);
  std::error_code error;
  fs::remove(temporary_, error);
}

void TarShard::add(const std::string& member, std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(), archive_entry_free);
  archive_entry_set_pathname(entry.get(), member.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), 0, 0);
  if (archive_write_header(archive_, entry.get()) != ARCHIVE_OK ||
      archive_write_data(archive_, bytes.data(), bytes.size()) != static_cast<la_ssize_t>(bytes.size())) {
    throw write_error(path_, archive_);
  }
}

void TarShard::finish() {
  if (archive_write_close(archive_) != ARCHIVE_OK) throw write_error(path_, archive_);
  archive_write_free(archive_);
  archive_ = nullptr;
  std::error_code error, no_throw;
  fs::rename(temporary_, path_, error);
  if (!error) return;
  fs::remove(temporary_, no_throw);
  throw disk_error(path_, error.message());
}

void read_tar(const fs::path& path,
              const std::function<void(const std::string&, const std::vector<std::uint8_t>&)>& visit) {
  std::error_code no_throw;
  if (!fs::is_regular_file(path, no_throw)) throw DataError(fmt::format("{}: no such file", path.string()));
  const std::unique_ptr<archive, decltype(&archive_read_free)> in(archive_read_new(), archive_read_free);
  archive_read_support_format_tar(in.get());
  if (archive_read_open_filename(in.get(), path.c_str(), 1 << 20) != ARCHIVE_OK) fail(path, in.get());
  archive_entry* entry = nullptr;
  for (;;) {
    const int status = archive_read_next_header(in.get(), &entry);
    if (status == ARCHIVE_EOF) return;
    if (status != ARCHIVE_OK) fail(path, in.get());
    const la_int64_t size = archive_entry_size(entry);
    if (size < 0 || size > max_member_bytes)
      throw DataError(fmt::format("{}: member of {} bytes", path.string(), size));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    if (archive_read_data(in.get(), bytes.data(), bytes.size()) != static_cast<la_ssize_t>(size)) fail(path, in.get());
    visit(archive_entry_pathname(entry), bytes);
  }
}

}  // namespace ensonify
