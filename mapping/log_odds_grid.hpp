#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ensonify/mapping/log_odds.hpp"
#include "ensonify/mapping/mark_box.hpp"
#include "ensonify/mapping/marks.hpp"

namespace ensonify {

/// An occupancy map: log-odds of the cells of a box, in blocks of 8 x 8 x 8 that exist once something was seen in them.
/// A map in two dimensions is a box one cell high: what lies above or below it is outside (its blocks are 8 high
/// still). A cell is unknown while its value is 0: never looked at, or looks that cancel, which say as little.
class LogOddsGrid {
 public:
  /// Throws ConfigError for a frame without cells, with 2^33 or more, with a resolution or origin that is no number, or
  /// limits that exclude 0.
  explicit LogOddsGrid(const GridFrame& frame, const LogOddsLimits& limits = {});

  const GridFrame& frame() const { return frame_; }
  const LogOddsLimits& limits() const { return limits_; }

  /// 0 outside the box.
  MilliLogOdds at(const Cell& cell) const;
  /// Throws ConfigError outside the box; the limits apply.
  void set(const Cell& cell, MilliLogOdds value);

  /// One ping: every marked cell takes one step. The result does not depend on the number of threads.
  void apply(const MarkBox<Mark>& marks, const LogOddsStep& step, UpdateLaw law = UpdateLaw::add);

  /// Values of 8 x 8 x 8 cells, x fastest. Blocks are numbered like cells of a grid (marked_blocks.hpp).
  using Block = std::array<MilliLogOdds, block_cells>;
  /// The limits apply. Blocks may be set by several threads, each by one.
  void set_block(std::size_t index, const Block& values);

  /// Bytes in use.
  std::size_t bytes() const;
  /// Bytes once every block of such a box is in use, and the marks of a ping that reaches all of it. Ask before making
  /// a grid; a fresh one takes 8 bytes a block.
  static std::size_t bytes_at_worst(const GridFrame& frame);

 private:
  std::size_t block_of(const Cell& cell) const;

  GridFrame frame_;
  LogOddsLimits limits_;
  Cell blocks_{};  ///< along x, y, z
  std::vector<std::unique_ptr<Block>> block_;
};

/// Throws ConfigError unless it has cells, less than 2^33, and numbers for origin and resolution.
void require_valid(const GridFrame& frame);

}  // namespace ensonify
