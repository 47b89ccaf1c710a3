#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace ensonify {

/// Running SHA-256.
class Sha256 {
 public:
  Sha256();
  Sha256& add(std::span<const std::uint8_t> bytes);
  Sha256& add(std::string_view text);
  /// 64 hexadecimal digits; ends the run.
  std::string hex();

 private:
  struct Context;
  std::shared_ptr<Context> context_;
};

/// Of the bytes of a file, a piece at a time. Throws DataError where it is no regular file or can not be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace ensonify
