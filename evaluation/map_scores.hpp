#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/mapping/cell_box.hpp"

/// How right a map is. As in Lin et al. (ICRA 2023), and nowhere else in this program, FREE is positive here.
namespace ensonify {

/// The truth of a box of cells, ready to score maps of it or of parts of it.
struct MapTruth {
  GridFrame frame;
  std::vector<std::uint8_t> occupied;  ///< 0 or 1: surface or interior
  std::vector<std::uint8_t> scored;    ///< 0 or 1: observable; what all maps are compared on
  std::vector<int> tolerances;         ///< cells, ascending
  /// Of each tolerance, whether a cell within so many cells along every axis (itself too) is occupied.
  std::vector<std::vector<std::uint8_t>> occupied_near;
};

/// Throws ConfigError for a grid without `observable`, or tolerances that do not ascend from 0 or more.
MapTruth map_truth(const OccupancyGrid& grid, const std::vector<int>& tolerances);

/// What depends on the tolerance of k cells. "Near": within k cells along every axis, the cell itself too.
struct ToleranceCounts {
  std::uint64_t right = 0;           ///< scored cells occupied in the map, an occupied one of the truth near
  std::uint64_t found = 0;           ///< scored cells occupied in truth, an occupied one of the map near, scored or not
  std::uint64_t false_free = 0;      ///< scored, free in the map, occupied in truth, none occupied in the map near
  std::uint64_t false_occupied = 0;  ///< scored, occupied in the map, free in truth, none occupied in truth near
};

/// Cells of a map at one threshold. All but the hidden ones are of the scored cells.
struct MapCounts {
  std::uint64_t true_free = 0;       ///< TP
  std::uint64_t false_free = 0;      ///< FP: free in the map, occupied in truth; the dangerous ones
  std::uint64_t true_occupied = 0;   ///< TN
  std::uint64_t false_occupied = 0;  ///< FN: occupied in the map, free in truth
  std::uint64_t observable = 0;      ///< all scored cells, unknown ones too
  std::uint64_t observable_occupied = 0;
  /// Beyond the scored cells (in shadows, inside of bodies): occupied in truth and known to the map, and free there.
  std::uint64_t hidden_occupied_known = 0, hidden_false_free = 0;
  /// Sum over known cells of (p - o)^2, p = 1 / (1 + exp(-L)), o = 1 where occupied; in units of 2^-30: integers, so
  /// that parts add up to the same in any order.
  std::uint64_t squared_error = 0;
  std::vector<ToleranceCounts> tolerant;  ///< in the order of MapTruth::tolerances

  MapCounts& operator+=(const MapCounts& other);

  std::uint64_t known() const { return true_free + false_free + true_occupied + false_occupied; }
  /// Rates; NaN for 0 / 0.
  double fpr() const;                ///< FP / (FP + TN): of the known occupied cells
  double fnr() const;                ///< FN / (FN + TP): of the known free cells
  double fp_share() const;           ///< FP / known
  double fn_share() const;           ///< FN / known
  double coverage() const;           ///< known / observable
  double balanced_accuracy() const;  ///< 1 - (FPR + FNR) / 2
  double brier() const;              ///< over known cells
  double brier_observable() const;   ///< over all scored cells, unknown ones with p = 1/2
  double iou() const;                ///< of occupied: TN / (TN + FN + occupied cells not marked so)
  /// Of occupied, with the tolerance number `i`: right / marked; found / observable_occupied (unknown is not found);
  /// their harmonic mean.
  double precision(std::size_t i) const;
  double recall(std::size_t i) const;
  double f1(std::size_t i) const;
  double tolerant_fpr(std::size_t i) const;  ///< of the tolerant false_free; the denominator is that of fpr()
  double tolerant_fnr(std::size_t i) const;
};

/// Counts the cells of `core` (indices of map.frame) of a map whose frame is a box of the truth's cells. A cell that
/// is near to one outside of map.frame takes that one as unknown: give parts as many cells more as the tolerance.
/// Throws ConfigError where the map's cells are not cells of the truth.
MapCounts count_map(const LogOddsMap& map, const MapTruth& truth, const CellBox& core);
MapCounts count_map(const LogOddsMap& map, const MapTruth& truth);

/// The least FNR of a curve over thresholds (straight lines between them) where FPR <= `fpr`. NaN where no point with
/// both rates has so low an FPR.
double fnr_at_fpr(std::span<const MapCounts> curve, double fpr);

}  // namespace ensonify
