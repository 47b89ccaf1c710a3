#include "ensonify/scenes/tyre.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "ensonify/scenes/loft.hpp"

namespace ensonify {
namespace {

enum class Row { none, lower, upper };

/// A point of the cross section: shares of the height from rim to tread, and of half the width.
struct SectionPoint {
  double up, across;
  Row row = Row::none;  ///< whose grooves cut it
};

// Outside from the lower bead over the tread to the upper one, then back inside.
constexpr double groove = 0.9;  // height of the ground of the grooves
const std::vector<SectionPoint>& section() {
  static const std::vector<SectionPoint> points{{0, -0.72},
                                                {0.12, -0.82},
                                                {0.35, -0.97},
                                                {0.55, -1},
                                                {0.75, -0.95},
                                                {0.97, -0.84, Row::lower},
                                                {1, -0.7, Row::lower},
                                                {1, -0.08, Row::lower},
                                                {groove, -0.06},
                                                {groove, 0.06},
                                                {1, 0.08, Row::upper},
                                                {1, 0.7, Row::upper},
                                                {0.97, 0.84, Row::upper},
                                                {0.75, 0.95},
                                                {0.55, 1},
                                                {0.35, 0.97},
                                                {0.12, 0.82},
                                                {0, 0.72},
                                                {0, 0.52},
                                                {0.14, 0.6},
                                                {0.4, 0.8},
                                                {0.65, 0.78},
                                                {0.78, 0.6},
                                                {0.8, 0},
                                                {0.78, -0.6},
                                                {0.65, -0.78},
                                                {0.4, -0.8},
                                                {0.14, -0.6},
                                                {0, -0.52}};
  return points;
}

}  // namespace

TriangleMesh make_tyre(const Tyre& tyre) {
  const double height_m = tyre.outer_radius_m - tyre.rim_radius_m;
  // A block spans eight steps, two of them groove; the rows are half a block apart.
  constexpr int steps_a_block = 8;
  const int steps = tyre.blocks > 0 ? steps_a_block * tyre.blocks : 64;
  const auto in_groove = [&](int step, Row row) {
    if (tyre.blocks == 0 || row == Row::none) return false;
    return (step + (row == Row::upper ? steps_a_block / 2 : 0)) % steps_a_block < 2;
  };
  std::vector<Ring> rings;
  for (int step = 0; step < steps; ++step) {
    // Steps come in pairs close together at the flanks of a groove, which makes the flanks steep.
    const double shift = step % 2 == 0 ? -0.35 : 0.35;
    const double angle = 2 * std::numbers::pi * (step + (tyre.blocks > 0 ? shift : 0)) / steps;
    Ring ring;
    for (const SectionPoint& point : section()) {
      const double up = in_groove(step, point.row) ? groove : point.up;
      const double radius_m = tyre.rim_radius_m + height_m * up;
      ring.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.5 * tyre.width_m * point.across);
    }
    rings.push_back(ring);
  }
  return loft_loop(rings);
}

}  // namespace ensonify
