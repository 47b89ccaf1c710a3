#pragma once

#include <filesystem>

namespace ensonify {

/// A lock on a file, which it makes: shared by all who work in a folder, or held alone by one who clears it. Ends with
/// the process, however that ends. Without effect on file systems that know no locks.
class FolderLock {
 public:
  /// Takes the lock together with others; waits while one holds it alone. Throws DiskError.
  explicit FolderLock(const std::filesystem::path& file);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

  /// Holds it alone from now on; false where others hold it too, and then it is shared as before.
  bool hold_alone();
  void share();

 private:
  int file_ = -1;
};

}  // namespace ensonify
