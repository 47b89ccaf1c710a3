#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct archive;

namespace ensonify {

/// Writes a WebDataset shard (ustar, fixed times and owners, so that equal samples give equal bytes). The file appears
/// under its name when finish() has returned, not before; dropped unfinished, it leaves nothing.
class TarShard {
 public:
  explicit TarShard(std::filesystem::path path);
  ~TarShard();
  TarShard(const TarShard&) = delete;
  TarShard& operator=(const TarShard&) = delete;

  /// Members that share the name up to the first dot form a sample. Throws DiskError.
  void add(const std::string& member, std::span<const std::uint8_t> bytes);
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  archive* archive_ = nullptr;
};

/// Calls visit(member name, bytes) for every file of a tar, in order. Throws DataError.
void read_tar(const std::filesystem::path& path,
              const std::function<void(const std::string&, const std::vector<std::uint8_t>&)>& visit);

}  // namespace ensonify
