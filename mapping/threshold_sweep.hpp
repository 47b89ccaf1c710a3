#pragma once

#include <vector>

#include "ensonify/core/posed_image.hpp"
#include "ensonify/mapping/inverse_model.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

/// The maps of many thresholds at the cost of about one: per cell it counts at how many pings each threshold was the
/// last to find it occupied, and the first to find it free. Equal, cell by cell, to separate maps without limits.
///
/// Memory: counts of 16 bits in blocks of 512 cells, a plane of them for every count that occurs in the block. Of n
/// thresholds at most 4 n bytes a cell of a block that was seen (244 for 61), half of it under `Points` and `Arc`, and
/// 2 bytes a cell for the marks of a ping; whatever the number of pings. A caller with less gives a part of the map as
/// `frame`, all pings, and the next part after.
class ThresholdSweep {
 public:
  /// `thresholds` ascending, 254 at most. Throws ConfigError as LogOddsGrid, classify() and the model do.
  ThresholdSweep(const GridFrame& frame, std::vector<double> thresholds, const InverseModel& model);

  /// Throws DataError as integrate_ping does, and after 65535 pings.
  void add(const PosedImage& ping);

  const std::vector<double>& thresholds() const { return thresholds_; }
  int pings() const { return pings_; }

  /// The map at thresholds()[k].
  LogOddsGrid map_at(int k) const;

  std::size_t bytes() const;
  /// At worst, for a frame and a number of thresholds: every block seen, every count in it.
  static std::size_t bytes_at_worst(const GridFrame& frame, int thresholds, const InverseModel& model);

 private:
  using Plane = std::array<std::uint16_t, block_cells>;
  /// Planes by count, none while it is 0 everywhere in the block.
  struct Block {
    std::vector<std::unique_ptr<Plane>> occupied_below;  ///< [e]: occupied at thresholds 0 .. e - 1
    std::vector<std::unique_ptr<Plane>> free_from;       ///< [k]: free at thresholds k, k + 1 ..
  };

  MilliLogOdds value_at(std::uint32_t occupied, std::uint32_t free) const;

  GridFrame frame_;
  std::vector<double> thresholds_;
  InverseModel model_;
  Cell blocks_{};
  std::vector<std::unique_ptr<Block>> block_;
  MarkBox<SweepMark> marks_;
  int pings_ = 0;
};

}  // namespace ensonify
