#include "ensonify/generators/observed_record.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

std::vector<ObservedCells> sample() {
  RandomSequence random(RandomKey::from_seed(4));
  std::vector<ObservedCells> frames{{0, {}}, {300, {{0, 1}, {2, 5}}}, {2, {{4'294'967'290u, 5}}}};
  ObservedCells many{1, {}};
  std::uint32_t at = 0;
  for (int i = 0; i < 2000; ++i) {
    at += static_cast<std::uint32_t>(random.uniform(0, 1e5));
    const auto count = static_cast<std::uint32_t>(random.uniform(1, 300));
    many.runs.push_back({at, count});
    at += count;
  }
  frames.push_back(many);
  return frames;
}

TEST(ObservedRecord, RoundTrip) {
  const auto frames = sample();
  const auto back = unpack(pack(frames), "x");
  ASSERT_EQ(back.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(back[i].place, frames[i].place);
    EXPECT_EQ(back[i].runs, frames[i].runs);
  }
  EXPECT_TRUE(unpack(pack({}), "x").empty());
}

// Bytes from a disk: whatever they are, runs come out ascending and within 2^32 cells, or an error names the file.
TEST(ObservedRecord, BrokenBytesAreRefusedOrHarmless) {
  const std::vector<std::uint8_t> whole = pack(sample());
  int refused = 0;
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    std::vector<std::uint8_t> bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i));
    bytes.insert(bytes.end(), {0xff, 0xff, 0xff, 0xff, 0xff});
    try {
      for (const ObservedCells& frame : unpack(bytes, "cells.bin")) {
        std::uint64_t end = 0;
        for (const CellRun& run : frame.runs) {
          ASSERT_GE(run.first, end);
          end = std::uint64_t{run.first} + run.count;
          ASSERT_LE(end, std::numeric_limits<std::uint32_t>::max());
        }
      }
    } catch (const DataError& e) {
      EXPECT_NE(std::string(e.what()).find("cells.bin"), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace ensonify
