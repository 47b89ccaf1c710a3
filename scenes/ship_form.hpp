#pragma once

#include <vector>

#include "ensonify/core/pose.hpp"
#include "ensonify/scenes/ship.hpp"

namespace ensonify {

/// The moulded surface of a ship: station u from 0 (stern) to 1 (stem), and points of the cross section.
class ShipForm {
 public:
  explicit ShipForm(const Ship& ship) : ship_(ship) {}

  /// Shares of the half beam (port positive) and of the depth.
  struct SectionPoint {
    double across, up;
  };
  /// The midship section: from the port deck edge round the keel to starboard, then back over the deck.
  std::vector<SectionPoint> section() const;
  /// How many points of it are of the sides and the bottom; the rest are of the deck.
  int shell_points() const { return 2 * half_points - 1; }

  Vec3 at(double u, const SectionPoint& point) const;
  double deck_z_m(double u) const;
  double deck_half_width_m(double u) const { return at(u, {1, 1}).y(); }
  /// Station whose deck is at x.
  double station_at(double x_m) const;
  /// x of the foremost and aftmost points at a share of the depth.
  double stem_x_m(double up) const;
  double stern_x_m(double up) const;

 private:
  static constexpr int half_points = 17;  // keel to deck edge
  double fullness(double u, double up) const;
  Ship ship_;
};

/// Deck points between starboard and port edge, as shares of the half beam; hatches are as wide as the outer ones.
constexpr double hatch_half_width = 0.56;

}  // namespace ensonify
