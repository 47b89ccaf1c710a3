#include "ensonify/evaluation/map_scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr double squared_error_unit = 1 << 30;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? no_number : static_cast<double>(part) / static_cast<double>(whole);
}

/// Along one axis: whether a cell within k cells is set. `n` cells, `stride` apart.
void spread(std::uint8_t* cells, int n, std::size_t stride, int k, std::vector<std::uint8_t>& line) {
  line.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) line[static_cast<std::size_t>(i)] = cells[static_cast<std::size_t>(i) * stride];
  int last = -k - 1;  // the set cell last passed
  int ahead = 0;      // cells looked at
  for (int i = 0; i < n; ++i) {
    for (; ahead < n && ahead <= i + k; ++ahead) {
      if (line[static_cast<std::size_t>(ahead)] != 0) last = ahead;
    }
    cells[static_cast<std::size_t>(i) * stride] = last >= i - k;
  }
}

std::vector<std::uint8_t> near(std::vector<std::uint8_t> cells, const GridFrame& frame, int k) {
  if (k == 0) return cells;
  const auto [nx, ny, nz] = frame.size;
  std::vector<std::uint8_t> line;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) spread(&cells[frame.index(0, y, z)], nx, 1, k, line);
    for (int x = 0; x < nx; ++x) spread(&cells[frame.index(x, 0, z)], ny, frame.index(0, 1, 0), k, line);
  }
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) spread(&cells[frame.index(x, y, 0)], nz, frame.index(0, 0, 1), k, line);
  }
  return cells;
}

/// Where the map's first cell lies among the truth's.
Cell place_in(const GridFrame& truth, const GridFrame& map) {
  Cell first{};
  bool fits = std::abs(map.resolution_m / truth.resolution_m - 1) < 1e-9;
  for (int a = 0; fits && a < 3; ++a) {
    const double cells = (map.origin_m[a] - truth.origin_m[a]) / truth.resolution_m;
    fits =
        std::abs(cells - std::round(cells)) < 1e-3 && cells > -0.5 && std::round(cells) + map.size[a] <= truth.size[a];
    if (fits) first[a] = static_cast<int>(std::lround(cells));
  }
  if (fits) return first;
  throw ConfigError(
      fmt::format("map of {} x {} x {} cells of {} m from ({}, {}, {}) m: scores need cells of the truth grid, {} x {} "
                  "x {} of {} m from ({}, {}, {}) m",
                  map.size[0], map.size[1], map.size[2], map.resolution_m, map.origin_m.x(), map.origin_m.y(),
                  map.origin_m.z(), truth.size[0], truth.size[1], truth.size[2], truth.resolution_m, truth.origin_m.x(),
                  truth.origin_m.y(), truth.origin_m.z()));
}

}  // namespace

MapTruth map_truth(const OccupancyGrid& grid, const std::vector<int>& tolerances) {
  const std::size_t cells = grid.frame.cells();
  if (grid.occupancy.size() != cells || grid.observable.size() != cells) {
    throw ConfigError("maps are scored where the truth grid says what was observable; this grid does not say");
  }
  for (std::size_t i = 0; i < tolerances.size(); ++i) {
    if (tolerances[i] < (i == 0 ? 0 : tolerances[i - 1] + 1)) {
      throw ConfigError("tolerances must ascend and begin at 0 cells or more");
    }
  }
  MapTruth truth{grid.frame, grid.occupancy, grid.observable, tolerances, {}};
  for (std::uint8_t& cell : truth.occupied) cell = cell != static_cast<std::uint8_t>(Occupancy::free);
  for (const int k : tolerances) truth.occupied_near.push_back(near(truth.occupied, truth.frame, k));
  return truth;
}

MapCounts& MapCounts::operator+=(const MapCounts& other) {
  true_free += other.true_free;
  false_free += other.false_free;
  true_occupied += other.true_occupied;
  false_occupied += other.false_occupied;
  observable += other.observable;
  observable_occupied += other.observable_occupied;
  hidden_occupied_known += other.hidden_occupied_known;
  hidden_false_free += other.hidden_false_free;
  squared_error += other.squared_error;
  tolerant.resize(std::max(tolerant.size(), other.tolerant.size()));
  for (std::size_t i = 0; i < other.tolerant.size(); ++i) {
    tolerant[i].right += other.tolerant[i].right;
    tolerant[i].found += other.tolerant[i].found;
    tolerant[i].false_free += other.tolerant[i].false_free;
    tolerant[i].false_occupied += other.tolerant[i].false_occupied;
  }
  return *this;
}

double MapCounts::fpr() const { return ratio(false_free, false_free + true_occupied); }
double MapCounts::fnr() const { return ratio(false_occupied, false_occupied + true_free); }
double MapCounts::fp_share() const { return ratio(false_free, known()); }
double MapCounts::fn_share() const { return ratio(false_occupied, known()); }
double MapCounts::coverage() const { return ratio(known(), observable); }
double MapCounts::balanced_accuracy() const { return 1 - 0.5 * (fpr() + fnr()); }
double MapCounts::brier() const {
  return known() == 0 ? no_number
                      : static_cast<double>(squared_error) / squared_error_unit / static_cast<double>(known());
}
double MapCounts::brier_observable() const {
  if (observable == 0) return no_number;
  return (static_cast<double>(squared_error) / squared_error_unit + 0.25 * static_cast<double>(observable - known())) /
         static_cast<double>(observable);
}
double MapCounts::iou() const { return ratio(true_occupied, observable_occupied + false_occupied); }
double MapCounts::precision(std::size_t i) const { return ratio(tolerant.at(i).right, true_occupied + false_occupied); }
double MapCounts::recall(std::size_t i) const { return ratio(tolerant.at(i).found, observable_occupied); }
double MapCounts::f1(std::size_t i) const {
  const double p = precision(i);
  const double r = recall(i);
  // Nothing marked is nothing found: 0, unless there is nothing to find.
  if (std::isnan(p)) return observable_occupied == 0 ? no_number : 0;
  return p + r == 0 ? 0 : 2 * p * r / (p + r);
}
double MapCounts::tolerant_fpr(std::size_t i) const {
  return ratio(tolerant.at(i).false_free, false_free + true_occupied);
}
double MapCounts::tolerant_fnr(std::size_t i) const {
  return ratio(tolerant.at(i).false_occupied, false_occupied + true_free);
}

MapCounts count_map(const LogOddsMap& map, const MapTruth& truth, const CellBox& core) {
  const Cell first = place_in(truth.frame, map.frame);
  // Asked of the few occupied cells of the truth only: cheaper than to spread all marks of the map.
  const auto marked_near = [&](const Cell& cell, int k) {
    const CellBox around =
        intersection({{cell[0] - k, cell[1] - k, cell[2] - k}, {cell[0] + k + 1, cell[1] + k + 1, cell[2] + k + 1}},
                     box_of(map.frame));
    for (int z = around.low[2]; z < around.high[2]; ++z) {
      for (int y = around.low[1]; y < around.high[1]; ++y) {
        const float* const row = &map.log_odds[map.frame.index(0, y, z)];
        if (std::any_of(row + around.low[0], row + around.high[0], [](float v) { return v > 0; })) return true;
      }
    }
    return false;
  };

  MapCounts n;
  n.tolerant.resize(truth.tolerances.size());
  const auto count_scored = [&](float value, bool is_occupied, const Cell& cell, std::size_t in_truth) {
    ++n.observable;
    n.observable_occupied += is_occupied;
    const bool marked = value > 0;
    const bool freed = value < 0;
    n.true_free += freed && !is_occupied;
    n.false_free += freed && is_occupied;
    n.true_occupied += marked && is_occupied;
    n.false_occupied += marked && !is_occupied;
    if (value != 0) {
      const double error = 1 / (1 + std::exp(-static_cast<double>(value))) - (is_occupied ? 1 : 0);
      n.squared_error += static_cast<std::uint64_t>(std::llround(error * error * squared_error_unit));
    }
    for (std::size_t i = 0; i < n.tolerant.size(); ++i) {
      const bool truth_near = truth.occupied_near[i][in_truth] != 0;
      n.tolerant[i].right += marked && truth_near;
      n.tolerant[i].false_occupied += marked && !is_occupied && !truth_near;
      if (!is_occupied) continue;
      const bool is_found = marked || marked_near(cell, truth.tolerances[i]);
      n.tolerant[i].found += is_found;
      n.tolerant[i].false_free += freed && !is_found;
    }
  };
  for (int z = core.low[2]; z < core.high[2]; ++z) {
    for (int y = core.low[1]; y < core.high[1]; ++y) {
      for (int x = core.low[0]; x < core.high[0]; ++x) {
        const std::size_t in_map = map.frame.index(x, y, z);
        const std::size_t in_truth = truth.frame.index(first[0] + x, first[1] + y, first[2] + z);
        const float value = map.log_odds[in_map];
        const bool is_occupied = truth.occupied[in_truth] != 0;
        if (truth.scored[in_truth] != 0) {
          count_scored(value, is_occupied, {x, y, z}, in_truth);
        } else if (is_occupied) {
          n.hidden_occupied_known += value != 0;
          n.hidden_false_free += value < 0;
        }
      }
    }
  }
  return n;
}

MapCounts count_map(const LogOddsMap& map, const MapTruth& truth) { return count_map(map, truth, box_of(map.frame)); }

double fnr_at_fpr(std::span<const MapCounts> curve, double fpr) {
  double least = no_number;
  const auto take = [&](double fnr) { least = std::isnan(least) ? fnr : std::min(least, fnr); };
  double fpr_before = no_number;
  double fnr_before = no_number;
  for (const MapCounts& at : curve) {
    const double p = at.fpr();
    const double n = at.fnr();
    if (std::isnan(p) || std::isnan(n)) {
      fpr_before = no_number;  // no line across a gap
      continue;
    }
    if (p <= fpr) take(n);
    const bool crosses = (fpr_before <= fpr) != (p <= fpr) && !std::isnan(fpr_before);
    if (crosses) take(fnr_before + (n - fnr_before) * (fpr - fpr_before) / (p - fpr_before));
    fpr_before = p;
    fnr_before = n;
  }
  return least;
}

}  // namespace ensonify
