#include "ensonify/mapping/log_odds_grid.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/marked_blocks.hpp"

namespace ensonify {
namespace {

constexpr double cells_at_most = 8589934592.0;  // 2^33

int position_in_block(const Cell& c) {
  constexpr int side = block_side;
  return ((c[2] % side) * side + c[1] % side) * side + c[0] % side;
}

/// Rows of 8 cells, so that the compiler can take each as one vector. Differences from the limits can not overflow:
/// values lie between the limits, and 0 lies between them too.
template <UpdateLaw law>
void step_row(const Mark* marks, MilliLogOdds* value, const LogOddsStep& step, const LogOddsLimits& limits) {
  const MilliLogOdds may_free = limits.lowest - step.free;
  const MilliLogOdds may_occupy = limits.highest - step.occupied;
  for (int i = 0; i < block_side; ++i) {
    const MilliLogOdds v = value[i];
    MilliLogOdds freed = v < may_free ? limits.lowest : v + step.free;
    MilliLogOdds occupied = v > may_occupy ? limits.highest : v + step.occupied;
    if constexpr (law == UpdateLaw::freed_for_good) {
      freed = v > 0 ? std::max(step.free, limits.lowest) : freed;
      occupied = v < 0 ? v : occupied;
    }
    value[i] = marks[i] == Mark::free ? freed : marks[i] == Mark::occupied ? occupied : v;
  }
}

}  // namespace

void require_valid(const GridFrame& frame) {
  double cells = 1;
  for (const int n : frame.size) cells *= n;
  if (*std::min_element(frame.size.begin(), frame.size.end()) < 1 || cells >= cells_at_most) {
    throw ConfigError(
        fmt::format("map of {} x {} x {} cells: it needs at least one along each axis and less than 2^33 in "
                    "all; take a coarser resolution or a smaller box",
                    frame.size[0], frame.size[1], frame.size[2]));
  }
  if (!(frame.resolution_m > 0 && std::isfinite(frame.resolution_m) && frame.origin_m.allFinite())) {
    throw ConfigError(
        fmt::format("map with origin ({}, {}, {}) m and resolution {} m: give finite numbers and a "
                    "resolution above 0",
                    frame.origin_m.x(), frame.origin_m.y(), frame.origin_m.z(), frame.resolution_m));
  }
}

LogOddsGrid::LogOddsGrid(const GridFrame& frame, const LogOddsLimits& limits) : frame_(frame), limits_(limits) {
  require_valid(frame);
  require_valid(limits);
  blocks_ = blocks_along(frame.size);
  block_.resize(block_count(blocks_));
}

std::size_t LogOddsGrid::block_of(const Cell& c) const {
  return block_index(blocks_, {c[0] / block_side, c[1] / block_side, c[2] / block_side});
}

MilliLogOdds LogOddsGrid::at(const Cell& cell) const {
  if (!box_of(frame_).contains(cell)) return 0;
  const auto& block = block_[block_of(cell)];
  return block ? (*block)[static_cast<std::size_t>(position_in_block(cell))] : 0;
}

void LogOddsGrid::set(const Cell& cell, MilliLogOdds value) {
  if (!box_of(frame_).contains(cell)) {
    throw ConfigError(fmt::format("cell ({}, {}, {}) lies outside the map of {} x {} x {} cells", cell[0], cell[1],
                                  cell[2], frame_.size[0], frame_.size[1], frame_.size[2]));
  }
  auto& block = block_[block_of(cell)];
  if (!block) block = std::make_unique<Block>(Block{});
  (*block)[static_cast<std::size_t>(position_in_block(cell))] = std::clamp(value, limits_.lowest, limits_.highest);
}

void LogOddsGrid::apply(const MarkBox<Mark>& marks, const LogOddsStep& step, UpdateLaw law) {
  require_valid(step);
  const LogOddsStep s = {std::max(step.free, limits_.lowest), std::min(step.occupied, limits_.highest)};
  for_each_marked_row(marks, blocks_, [&](std::size_t index, int row, const Mark* mark) {
    auto& block = block_[index];
    if (!block) block = std::make_unique<Block>(Block{});
    MilliLogOdds* value = block->data() + row * block_side;
    if (law == UpdateLaw::add) {
      step_row<UpdateLaw::add>(mark, value, s, limits_);
    } else {
      step_row<UpdateLaw::freed_for_good>(mark, value, s, limits_);
    }
  });
}

void LogOddsGrid::set_block(std::size_t index, const Block& values) {
  auto& block = block_.at(index);
  block = std::make_unique<Block>(values);
  for (MilliLogOdds& v : *block) v = std::clamp(v, limits_.lowest, limits_.highest);
}

std::size_t LogOddsGrid::bytes() const {
  std::size_t n = block_.size() * sizeof(block_[0]);
  for (const auto& block : block_) n += block ? sizeof(Block) : 0;
  return n;
}

std::size_t LogOddsGrid::bytes_at_worst(const GridFrame& frame) {
  require_valid(frame);
  return block_count(blocks_along(frame.size)) * (sizeof(std::unique_ptr<Block>) + sizeof(Block) + block_cells);
}

}  // namespace ensonify
