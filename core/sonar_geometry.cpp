#include "ensonify/core/sonar_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace ensonify {

Spherical to_spherical(const Vec3& p) {
  return {p.norm(), std::atan2(p.y(), p.x()), std::atan2(p.z(), std::hypot(p.x(), p.y()))};
}

Vec3 from_spherical(const Spherical& s) {
  const double horizontal_m = s.range_m * std::cos(s.elevation_rad);
  return {horizontal_m * std::cos(s.azimuth_rad), horizontal_m * std::sin(s.azimuth_rad),
          s.range_m * std::sin(s.elevation_rad)};
}

std::optional<int> SonarGeometry::bin_of(double range_m) const {
  if (!(range_m >= range_min_m && range_m < range_max_m)) return std::nullopt;
  const int bin = static_cast<int>((range_m - range_min_m) / bin_size_m());
  return std::min(bin, range_bins - 1);
}

std::vector<double> SonarGeometry::beam_edges_rad() const {
  const auto& centre = beam_azimuth_rad;
  const std::size_t n = centre.size();
  std::vector<double> edges(n + 1);
  for (std::size_t b = 1; b < n; ++b) edges[b] = 0.5 * (centre[b - 1] + centre[b]);
  const double first_half = n > 1 ? centre[0] - edges[1] : 0.0;
  const double last_half = n > 1 ? edges[n - 1] - centre[n - 1] : 0.0;
  edges[0] = centre[0] + first_half;
  edges[n] = centre[n - 1] - last_half;
  return edges;
}

std::optional<int> SonarGeometry::beam_of(double azimuth_rad) const {
  const std::vector<double> edges = beam_edges_rad();
  const auto below = std::upper_bound(edges.begin(), edges.end(), azimuth_rad, std::greater<>{});
  if (below == edges.begin() || below == edges.end()) return std::nullopt;
  return static_cast<int>(below - edges.begin()) - 1;
}

}  // namespace ensonify
