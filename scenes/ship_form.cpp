#include "ensonify/scenes/ship_form.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

std::vector<ShipForm::SectionPoint> ShipForm::section() const {
  const double bilge_across = 2 * ship_.bilge_radius_m / ship_.beam_m, bilge_up = ship_.bilge_radius_m / ship_.depth_m;
  std::vector<SectionPoint> half;
  constexpr int on_bottom = 4, on_bilge = 5;
  for (int i = 0; i < on_bottom; ++i) half.push_back({(1 - bilge_across) * i / on_bottom, 0});
  for (int i = 0; i < on_bilge; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / on_bilge;
    half.push_back({1 - bilge_across * (1 - std::sin(angle)), bilge_up * (1 - std::cos(angle))});
  }
  constexpr int on_side = half_points - on_bottom - on_bilge;
  for (int i = 0; i < on_side; ++i) half.push_back({1, bilge_up + (1 - bilge_up) * i / (on_side - 1)});

  std::vector<SectionPoint> ring(half.rbegin(), half.rend());
  for (std::size_t i = 1; i < half.size(); ++i) ring.push_back({-half[i].across, half[i].up});
  for (const double across : {-1.0, -0.5, 0.0, 0.5, 1.0}) ring.push_back({hatch_half_width * across, 1});
  return ring;
}

double ShipForm::fullness(double u, double up) const {
  constexpr double run_ends = 0.3, entrance_begins = 0.68;
  if (u > entrance_begins) {
    const double v = (u - entrance_begins) / (1 - entrance_begins);
    return std::max(0.0, 1 - std::pow(v, 1.35 + 1.9 * std::pow(up, 1.5)));
  }
  if (u >= run_ends) return 1;
  const double waterline = ship_.draft_m / ship_.depth_m;
  const double at_stern = 0.05 + 0.77 * smooth_step(0.45 * waterline, 1.15 * waterline, up);
  return 1 - (1 - at_stern) * std::pow(1 - u / run_ends, 1.5 + 1.5 * up);
}

double ShipForm::stem_x_m(double up) const {
  return ship_.length_m * (0.5 - 0.05 * std::pow(1 - std::clamp(up, 0.0, 1.0), 0.8));
}

double ShipForm::stern_x_m(double up) const {
  const double waterline = ship_.draft_m / ship_.depth_m;
  return ship_.length_m * (-0.43 - 0.07 * smooth_step(0.6 * waterline, 1.05 * waterline, up));
}

double ShipForm::deck_z_m(double u) const {
  const double sheer_m = ship_.length_m * (0.016 * std::pow(std::max(0.0, u - 0.5) / 0.5, 2) +
                                           0.006 * std::pow(std::max(0.0, 0.4 - u) / 0.4, 2));
  return ship_.depth_m - ship_.draft_m + sheer_m;
}

Vec3 ShipForm::at(double u, const SectionPoint& point) const {
  const double x = (1 - u) * stern_x_m(point.up) + u * stem_x_m(point.up);
  const double y = 0.5 * ship_.beam_m * point.across * fullness(u, point.up);
  return {x, y, -ship_.draft_m + point.up * (deck_z_m(u) + ship_.draft_m)};
}

double ShipForm::station_at(double x_m) const { return (x_m - stern_x_m(1)) / (stem_x_m(1) - stern_x_m(1)); }

}  // namespace ensonify
