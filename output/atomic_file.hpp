#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace ensonify {

/// A file that appears whole or not at all: written under another name in the same folder, put on the disk and renamed
/// by commit(). Without commit() nothing is left behind. Every failure is a DataError that names the path.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* doing, int error_number);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// Writes all of `bytes` to `path`, atomically.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace ensonify
