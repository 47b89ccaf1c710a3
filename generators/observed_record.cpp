#include "ensonify/generators/observed_record.hpp"

#include <fmt/format.h>

#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

void put(std::vector<std::uint8_t>& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
  out.push_back(static_cast<std::uint8_t>(value));
}

class Bytes {
 public:
  Bytes(std::span<const std::uint8_t> bytes, const std::filesystem::path& name) : bytes_(bytes), name_(name) {}

  bool at_end() const { return bytes_.empty(); }

  std::uint32_t number() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      if (bytes_.empty()) break;
      const std::uint8_t byte = bytes_.front();
      bytes_ = bytes_.subspan(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80 && value <= std::numeric_limits<std::uint32_t>::max()) return static_cast<std::uint32_t>(value);
    }
    fail();
  }

  [[noreturn]] void fail() const {
    throw DataError(
        fmt::format("{}: no record of observed cells; delete the block's record to make it again", name_.string()));
  }

 private:
  std::span<const std::uint8_t> bytes_;
  const std::filesystem::path& name_;
};

}  // namespace

std::vector<std::uint8_t> pack(const std::vector<ObservedCells>& frames) {
  std::vector<std::uint8_t> out;
  for (const ObservedCells& frame : frames) {
    put(out, static_cast<std::uint64_t>(frame.place));
    put(out, frame.runs.size());
    std::uint32_t end = 0;
    for (const CellRun& run : frame.runs) {
      put(out, run.first - end);
      put(out, run.count);
      end = run.first + run.count;
    }
  }
  return out;
}

std::vector<ObservedCells> unpack(std::span<const std::uint8_t> packed, const std::filesystem::path& name) {
  Bytes bytes(packed, name);
  std::vector<ObservedCells> frames;
  while (!bytes.at_end()) {
    ObservedCells frame{static_cast<int>(bytes.number()), {}};
    const std::uint32_t runs = bytes.number();
    std::uint64_t end = 0;
    for (std::uint32_t i = 0; i < runs; ++i) {
      const std::uint64_t first = end + bytes.number(), count = bytes.number();
      end = first + count;
      if (end > std::numeric_limits<std::uint32_t>::max()) bytes.fail();
      frame.runs.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace ensonify
