#include "ensonify/mapping/threshold_sweep.hpp"

#include <fmt/format.h>

#include "ensonify/core/error.hpp"
#include "ensonify/mapping/mark_ping.hpp"
#include "ensonify/mapping/marked_blocks.hpp"

namespace ensonify {
namespace {

constexpr int most_pings = 65535;

/// Models by which a cell is either occupied or free, so that one count tells the other.
bool leaves_nothing_open(const InverseModel& model) {
  return std::holds_alternative<Points>(model) || std::holds_alternative<Arc>(model);
}

template <typename Plane>
void count(std::vector<std::unique_ptr<Plane>>& planes, int which, int cell) {
  auto& plane = planes[static_cast<std::size_t>(which)];
  if (!plane) plane = std::make_unique<Plane>(Plane{});
  ++(*plane)[static_cast<std::size_t>(cell)];
}

template <typename Plane>
void sum(const std::vector<std::unique_ptr<Plane>>& planes, int first, int last,
         std::array<std::uint32_t, block_cells>& total) {
  for (int k = first; k <= last; ++k) {
    const auto& plane = planes[static_cast<std::size_t>(k)];
    if (!plane) continue;
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += (*plane)[i];
  }
}

}  // namespace

ThresholdSweep::ThresholdSweep(const GridFrame& frame, std::vector<double> thresholds, const InverseModel& model)
    : frame_(frame), thresholds_(std::move(thresholds)), model_(model) {
  require_valid(frame_);
  require_valid(model_);
  require_valid(thresholds_);
  blocks_ = blocks_along(frame_.size);
  block_.resize(block_count(blocks_));
}

void ThresholdSweep::add(const PosedImage& ping) {
  if (pings_ == most_pings) {
    throw DataError(fmt::format("a sweep over thresholds counts at most {} pings; split the pings", most_pings));
  }
  require_valid(ping, model_, frame_);
  mark_ping(ping, classify(ping.grey, thresholds_), model_, frame_, marks_);
  ++pings_;
  const bool one_count = leaves_nothing_open(model_);
  const int n = static_cast<int>(thresholds_.size());
  for_each_marked_row(marks_, blocks_, [&](std::size_t index, int row, const SweepMark* mark) {
    auto& block = block_[index];
    if (!block) {
      block = std::make_unique<Block>();
      block->free_from.resize(static_cast<std::size_t>(n) + 1);
      block->occupied_below.resize(one_count ? 0 : static_cast<std::size_t>(n) + 1);
    }
    for (int i = 0; i < block_side; ++i) {
      if (mark[i].echo_plus_1 == 0) continue;
      const int echo = mark[i].echo_plus_1 - 1;
      const int before = mark[i].before_plus_1 - 1;
      if (before < n || one_count) count(block->free_from, before, row * block_side + i);
      if (echo > 0 && !one_count) count(block->occupied_below, echo, row * block_side + i);
    }
  });
}

MilliLogOdds ThresholdSweep::value_at(std::uint32_t occupied, std::uint32_t free) const {
  const LogOddsStep& step = step_of(model_);
  std::int64_t value = std::int64_t{step.occupied} * occupied;
  if (law_of(model_) == UpdateLaw::freed_for_good && free > 0) value = 0;
  value += std::int64_t{step.free} * free;
  const LogOddsLimits limits;
  return static_cast<MilliLogOdds>(std::clamp<std::int64_t>(value, limits.lowest, limits.highest));
}

LogOddsGrid ThresholdSweep::map_at(int k) const {
  const int n = static_cast<int>(thresholds_.size());
  if (k < 0 || k >= n) throw ConfigError(fmt::format("threshold number {} of a sweep over {}", k, n));
  LogOddsGrid grid(frame_);
  parallel_for(static_cast<int>(block_.size()), [&](int index) {
    const auto& block = block_[static_cast<std::size_t>(index)];
    if (!block) return;
    std::array<std::uint32_t, block_cells> occupied{};
    std::array<std::uint32_t, block_cells> free{};
    sum(block->free_from, 0, k, free);
    sum(block->occupied_below.empty() ? block->free_from : block->occupied_below, k + 1, n, occupied);
    LogOddsGrid::Block values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_at(occupied[i], free[i]);
    grid.set_block(static_cast<std::size_t>(index), values);
  });
  return grid;
}

std::size_t ThresholdSweep::bytes() const {
  std::size_t n = block_.size() * sizeof(block_[0]);
  for (const auto& block : block_) {
    if (!block) continue;
    n += sizeof(Block) + (block->free_from.size() + block->occupied_below.size()) * sizeof(block->free_from[0]);
    for (const auto* planes : {&block->free_from, &block->occupied_below}) {
      for (const auto& plane : *planes) n += plane ? sizeof(Plane) : 0;
    }
  }
  return n;
}

std::size_t ThresholdSweep::bytes_at_worst(const GridFrame& frame, int thresholds, const InverseModel& model) {
  require_valid(frame);
  const std::size_t n = static_cast<std::size_t>(thresholds);
  const std::size_t planes = leaves_nothing_open(model) ? n + 1 : 2 * n;
  const std::size_t pointers = leaves_nothing_open(model) ? n + 1 : 2 * (n + 1);
  return block_count(blocks_along(frame.size)) *
         (sizeof(std::unique_ptr<Block>) + sizeof(Block) + planes * sizeof(Plane) +
          pointers * sizeof(std::unique_ptr<Plane>) + block_cells * sizeof(SweepMark));
}

}  // namespace ensonify
