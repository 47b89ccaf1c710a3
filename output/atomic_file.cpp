#include "ensonify/output/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "ensonify/core/error.hpp"

namespace ensonify {
AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  // Two threads or processes that write the same path must not share a temporary, and a killed one may have left one.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_ = fmt::format("{}.tmp-{}", path_.string(), ::getpid());
    if (attempt > 0) temporary_ += fmt::format("-{}", attempt);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    if (errno != EEXIST) break;
  }
  fail("create", errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    // Linux takes at most 2 GiB a call.
    const ssize_t written = ::write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), 1U << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  // Pipes and some file systems can not sync; that is no failure.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail("write", errno);
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 || ::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int error_number = errno;
    ::unlink(temporary_.c_str());
    fail("write", error_number);
  }
}

void AtomicFile::fail(const char* doing, int error_number) {
  throw DataError(fmt::format("can not {} {}: {}; check the folder, its permissions and the free space", doing,
                              path_.string(), std::strerror(error_number)));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace ensonify
