#pragma once

#include <cstdint>
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

}  // namespace ensonify
