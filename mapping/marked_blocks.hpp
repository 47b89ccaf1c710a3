#pragma once

#include <cstdint>
#include <cstring>

#include "ensonify/core/parallel.hpp"
#include "ensonify/mapping/mark_box.hpp"

namespace ensonify {

/// Blocks needed along each axis.
inline Cell blocks_along(const Cell& cells) {
  Cell n{};
  for (int a = 0; a < 3; ++a) n[a] = (cells[a] - 1) / block_side + 1;
  return n;
}
inline std::size_t block_count(const Cell& blocks) {
  return static_cast<std::size_t>(blocks[0]) * static_cast<std::size_t>(blocks[1]) *
         static_cast<std::size_t>(blocks[2]);
}
inline std::size_t block_index(const Cell& blocks, const Cell& b) {
  return (static_cast<std::size_t>(b[2]) * static_cast<std::size_t>(blocks[1]) + static_cast<std::size_t>(b[1])) *
             static_cast<std::size_t>(blocks[0]) +
         static_cast<std::size_t>(b[0]);
}

/// Calls visit(block index, row in the block, marks of its 8 cells) for every row that has a mark, rows of one block
/// one after another in one thread, blocks in parallel. `blocks` counts the blocks of the grid.
template <typename M, typename Visit>
void for_each_marked_row(const MarkBox<M>& marks, const Cell& blocks, const Visit& visit) {
  constexpr int side = block_side;
  const auto [nx, ny, nz] = marks.blocks();
  const auto stride = marks.layout().stride;
  const Cell first = marks.layout().first;
  parallel_for(ny * nz, [&, nx = nx, ny = ny](int i) {
    const M* bar = marks.data() + side * (stride[1] * (i % ny) + stride[2] * (i / ny));
    for (int bx = 0; bx < nx; ++bx, bar += side) {
      const std::size_t block =
          block_index(blocks, {first[0] / side + bx, first[1] / side + i % ny, first[2] / side + i / ny});
      for (int row = 0; row < side * side; ++row) {
        const M* mark = bar + stride[1] * (row % side) + stride[2] * (row / side);
        std::array<std::uint64_t, sizeof(M)> bits;
        std::memcpy(bits.data(), mark, sizeof(bits));
        std::uint64_t any = 0;
        for (const std::uint64_t b : bits) any |= b;
        if (any != 0) visit(block, row, mark);
      }
    }
  });
}

}  // namespace ensonify
