#include "ensonify/output/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ensonify/output/atomic_file.hpp"

namespace ensonify {

FolderLock::FolderLock(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw disk_error(file.parent_path(), error.message());
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file_ < 0) throw disk_error(file, std::strerror(errno));
  share();
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

bool FolderLock::hold_alone() {
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return true;
  share();  // the attempt gave up the share
  return false;
}

void FolderLock::share() {
  while (::flock(file_, LOCK_SH) != 0 && errno == EINTR) {
  }
}

}  // namespace ensonify
