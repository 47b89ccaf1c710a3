#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ensonify {

/// One bit a cell of a box of a grid. Rows run along x and begin on a word of their own, so that 64 cells are handled
/// at a time. Local cell (x, y, z) is the cell low + (x, y, z) of the grid.
struct BitGrid {
  std::array<int, 3> low{};   ///< grid index of the first cell; may lie outside the grid
  std::array<int, 3> size{};  ///< cells along x, y, z
  int row_words = 0;
  std::vector<std::uint64_t> words;

  BitGrid() = default;
  BitGrid(const std::array<int, 3>& low_, const std::array<int, 3>& size_)
      : low(low_),
        size(size_),
        row_words((size_[0] + 63) / 64),
        words(static_cast<std::size_t>(row_words) * static_cast<std::size_t>(size_[1]) *
              static_cast<std::size_t>(size_[2])) {}

  int rows() const { return size[1] * size[2]; }
  std::uint64_t* row(int y, int z) { return words.data() + row_start(y, z); }
  const std::uint64_t* row(int y, int z) const { return words.data() + row_start(y, z); }

  bool test(int x, int y, int z) const { return (row(y, z)[x >> 6] >> (x & 63)) & 1U; }

  /// Thread-safe; the order of calls does not change the result.
  void set(int x, int y, int z) {
    const std::atomic_ref<std::uint64_t> word(row(y, z)[x >> 6]);
    const std::uint64_t bit = std::uint64_t{1} << (x & 63);
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
  }
  /// Thread-safe; the order of calls does not change the result.
  void flip(int x, int y, int z) {
    const std::atomic_ref<std::uint64_t> word(row(y, z)[x >> 6]);
    word.fetch_xor(std::uint64_t{1} << (x & 63), std::memory_order_relaxed);
  }

  std::size_t count() const {
    std::size_t n = 0;
    for (const std::uint64_t word : words) n += static_cast<std::size_t>(std::popcount(word));
    return n;
  }

 private:
  std::size_t row_start(int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
           static_cast<std::size_t>(row_words);
  }
};

}  // namespace ensonify
