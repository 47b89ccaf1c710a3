#pragma once

#include <vector>

#include "ensonify/mapping/cell_box.hpp"

namespace ensonify {

/// Cells along the side of a block of a grid.
constexpr int block_side = 8;
constexpr int block_cells = block_side * block_side * block_side;

/// The marks of one ping, a byte or two a cell of the box that it can reach. They are set once the ping is read
/// completely, so that a cell is updated once a ping whatever the order of its pixels. A mark is forgotten with its
/// ping: there is no stamp that could be mistaken for another ping's. Scratch memory, to be used again.
template <typename M>
class MarkBox {
 public:
  /// Empties it and moves it to `box`; memory is of the blocks that hold those cells.
  void reset(const CellBox& box) {
    layout_.box = box;
    for (int a = 0; a < 3; ++a) {
      layout_.first[a] = box.low[a] / block_side * block_side;
      blocks_[a] = box.empty() ? 0 : (box.high[a] - 1) / block_side + 1 - box.low[a] / block_side;
    }
    layout_.stride = {1, block_side * blocks_[0], std::ptrdiff_t{block_side} * block_side * blocks_[0] * blocks_[1]};
    marks_.assign(static_cast<std::size_t>(layout_.stride[2] * block_side * blocks_[2]), M{});
  }

  const StridedBox& layout() const { return layout_; }
  const Cell& blocks() const { return blocks_; }
  M* data() { return marks_.data(); }
  const M* data() const { return marks_.data(); }
  M at(const Cell& c) const { return marks_[static_cast<std::size_t>(layout_.offset(c))]; }

 private:
  StridedBox layout_;
  Cell blocks_{};
  std::vector<M> marks_;
};

}  // namespace ensonify
