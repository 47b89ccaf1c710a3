#include "ensonify/generators/lost_files.hpp"

#include "ensonify/core/error.hpp"
#include "ensonify/generators/file_list.hpp"
#include "ensonify/generators/write_block.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> cut_short(const DatasetPaths& paths, const Block& block) {
  try {
    for (const WrittenFile& f : read_block_record(paths, block).files) {
      std::error_code error;
      if (fs::file_size(paths.root / f.name, error) != f.bytes || error) return f.name;
    }
  } catch (const DataError&) {  // the record is of use while the set is made; a finished one does without
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> lost_file(const DatasetPaths& paths, const std::vector<Block>& blocks) {
  for (const Block& block : blocks) {
    if (auto name = cut_short(paths, block)) return name;
  }
  try {
    for (const auto& [name, sha256] : read_file_list(paths.checksums())) {
      std::error_code error;
      if (!fs::is_regular_file(paths.root / name, error)) return name;
    }
  } catch (const DataError&) {
    return paths.checksums().filename().string();
  }
  return std::nullopt;
}

}  // namespace ensonify
