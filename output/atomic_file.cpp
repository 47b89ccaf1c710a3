#include "ensonify/output/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path) { throw disk_error(path, std::strerror(errno)); }

/// `path` is what the message names; the bytes go to `temporary`.
void write_bytes(const fs::path& path, const fs::path& temporary, const void* data, std::size_t size) {
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(path);
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(file, next, size);
    if (written < 0) {
      if (errno == EINTR) continue;
      const int error = errno;
      ::close(file);
      errno = error;
      fail(path);
    }
    next += written;
    size -= static_cast<std::size_t>(written);
  }
  if (::close(file) != 0) fail(path);
}

template <typename Bytes>
Bytes read_bytes(const fs::path& path, std::size_t max_bytes) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) throw DataError(fmt::format("{}: can not be read: {}", path.string(), error.message()));
  if (!fs::is_regular_file(path, error)) throw DataError(fmt::format("{}: is no regular file", path.string()));
  if (size > max_bytes)
    throw DataError(fmt::format("{}: {} bytes is more than the {} allowed", path.string(), size, max_bytes));
  Bytes bytes(size, {});
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!in && size > 0) throw DataError(fmt::format("{}: can not be read", path.string()));
  return bytes;
}

/// ".tmp-<machine>-", before the process id.
std::string temporary_mark() {
  std::array<char, 256> machine{};
  ::gethostname(machine.data(), machine.size() - 1);
  return fmt::format(".tmp-{}-", machine.data());
}

/// False where `name` is a temporary of a process of this machine that is gone, or of this very process.
bool is_in_use(std::string_view name, std::string_view mark) {
  const std::size_t at = name.rfind(mark);
  if (!name.starts_with('.') || at == std::string_view::npos) return true;
  const std::string_view digits = name.substr(at + mark.size());
  pid_t process = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), process);
  if (error != std::errc() || end != digits.data() + digits.size() || process <= 0) return true;
  return process != ::getpid() && (::kill(process, 0) == 0 || errno != ESRCH);
}

template <typename Iterator>
void remove_abandoned_of(const fs::path& folder) {
  const std::string mark = temporary_mark();
  std::error_code error;
  std::vector<fs::path> abandoned;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!is_in_use(entry->path().filename().native(), mark)) abandoned.push_back(entry->path());
  }
  for (const fs::path& path : abandoned) fs::remove(path, error);
}

void make_parent(const fs::path& path) {
  if (!path.has_parent_path()) return;
  const fs::path folder = path.parent_path();
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw DiskError(fmt::format("{}: folder can not be made: {}", folder.string(), error.message()));
}

}  // namespace

DiskError disk_error(const fs::path& path, const std::string& reason) {
  return DiskError(fmt::format("{}: can not be written: {}", path.string(), reason));
}

fs::path temporary_name(const fs::path& path) {
  return path.parent_path() / fmt::format(".{}{}{}", path.filename().string(), temporary_mark(), ::getpid());
}

void remove_abandoned(const fs::path& folder) { remove_abandoned_of<fs::recursive_directory_iterator>(folder); }

void remove_abandoned_beside(const fs::path& folder) { remove_abandoned_of<fs::directory_iterator>(folder); }

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  make_parent(path);
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) throw disk_error(path, "it is no regular file");
  const fs::path temporary = temporary_name(path);
  try {
    write(temporary);
    fs::rename(temporary, path);
  } catch (const fs::filesystem_error& e) {
    fs::remove(temporary, error);
    throw disk_error(path, e.code().message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

bool write_new_file(const fs::path& path, std::string_view text) {
  make_parent(path);
  const fs::path temporary = temporary_name(path);
  std::error_code error, no_throw;
  try {
    write_bytes(path, temporary, text.data(), text.size());
  } catch (...) {
    fs::remove(temporary, no_throw);
    throw;
  }
  fs::create_hard_link(temporary, path, error);
  if (error && error != std::errc::file_exists && !fs::exists(path, no_throw)) {
    fs::rename(temporary, path, error);  // a file system without links, where the last one wins
  } else {
    fs::remove(temporary, no_throw);
  }
  if (error && error != std::errc::file_exists) throw disk_error(path, error.message());
  return !error;
}

void write_file(const fs::path& path, std::span<const std::uint8_t> bytes) {
  write_atomically(path, [&](const fs::path& temporary) { write_bytes(path, temporary, bytes.data(), bytes.size()); });
}

void write_file(const fs::path& path, std::string_view text) {
  write_atomically(path, [&](const fs::path& temporary) { write_bytes(path, temporary, text.data(), text.size()); });
}

std::vector<std::uint8_t> read_file(const fs::path& path, std::size_t max_bytes) {
  return read_bytes<std::vector<std::uint8_t>>(path, max_bytes);
}

std::string read_text(const fs::path& path, std::size_t max_bytes) { return read_bytes<std::string>(path, max_bytes); }

}  // namespace ensonify
