#include "ensonify/sim/outside_fill.hpp"

#include <utility>
#include <vector>

namespace ensonify {
namespace {

/// Extends the set bits of `row` to both sides through the bits of `open`, which hold them, by doubling steps.
void spread_along_x(std::uint64_t* row, const std::uint64_t* open, int words) {
  std::uint64_t from_below = 0;
  for (int i = 0; i < words; ++i) {
    std::uint64_t flood = row[i] | (from_below & open[i]);
    std::uint64_t path = open[i];
    for (int shift = 1; shift < 64; shift *= 2) {
      flood |= path & (flood << shift);
      path &= path << shift;
    }
    row[i] = flood;
    from_below = flood >> 63;
  }
  std::uint64_t from_above = 0;
  for (int i = words - 1; i >= 0; --i) {
    std::uint64_t flood = row[i] | (from_above & open[i]);
    std::uint64_t path = open[i];
    for (int shift = 1; shift < 64; shift *= 2) {
      flood |= path & (flood >> shift);
      path &= path >> shift;
    }
    row[i] = flood;
    from_above = flood << 63;
  }
}

}  // namespace

BitGrid enclosed_by(const BitGrid& walls) {
  BitGrid open(walls.low, walls.size);
  BitGrid outside(walls.low, walls.size);
  const int words = walls.row_words;
  const int used = walls.size[0] & 63;
  const std::uint64_t last_mask = used ? (std::uint64_t{1} << used) - 1 : ~std::uint64_t{0};
  for (std::size_t i = 0; i < open.words.size(); ++i) {
    const bool last = (i + 1) % static_cast<std::size_t>(words) == 0;
    open.words[i] = ~walls.words[i] & (last ? last_mask : ~std::uint64_t{0});
  }

  // A row waits at most once: it is worked off whole.
  std::vector<std::pair<int, int>> waiting;
  std::vector<char> is_waiting(static_cast<std::size_t>(walls.rows()), 0);
  const auto reach = [&](int y, int z, const std::uint64_t* source) {
    std::uint64_t* row = outside.row(y, z);
    const std::uint64_t* free = open.row(y, z);
    std::uint64_t news = 0;
    for (int i = 0; i < words; ++i) news |= source[i] & free[i] & ~row[i];
    if (!news) return;
    for (int i = 0; i < words; ++i) row[i] |= source[i] & free[i];
    spread_along_x(row, free, words);
    char& flag =
        is_waiting[static_cast<std::size_t>(z) * static_cast<std::size_t>(walls.size[1]) + static_cast<std::size_t>(y)];
    if (!flag) waiting.emplace_back(y, z);
    flag = 1;
  };

  // The rim: whole rows at the border of y and z; the two ends of every row follow from these.
  const std::vector<std::uint64_t> all(static_cast<std::size_t>(words), ~std::uint64_t{0});
  for (int z = 0; z < walls.size[2]; ++z) {
    for (int y = 0; y < walls.size[1]; ++y) {
      if (y == 0 || z == 0 || y == walls.size[1] - 1 || z == walls.size[2] - 1) reach(y, z, all.data());
    }
  }
  while (!waiting.empty()) {
    const auto [y, z] = waiting.back();
    waiting.pop_back();
    is_waiting[static_cast<std::size_t>(z) * static_cast<std::size_t>(walls.size[1]) + static_cast<std::size_t>(y)] = 0;
    const std::uint64_t* row = outside.row(y, z);
    if (y > 0) reach(y - 1, z, row);
    if (y + 1 < walls.size[1]) reach(y + 1, z, row);
    if (z > 0) reach(y, z - 1, row);
    if (z + 1 < walls.size[2]) reach(y, z + 1, row);
  }

  for (std::size_t i = 0; i < open.words.size(); ++i) open.words[i] &= ~outside.words[i];
  return open;
}

}  // namespace ensonify
