#include "ensonify/sim/ray_fan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

constexpr double least_two_way_db = -40.0;
constexpr double bins_per_row = 3.0;
constexpr int max_elevation_rays = 8192;

int choose_elevation_rays(const SonarModel& sonar, double half_arc) {
  if (sonar.rays.elevation_rays > 0) return (sonar.rays.elevation_rays + 7) / 8 * 8;
  const double arc_bins = 2.0 * half_arc * sonar.geometry.range_max_m / sonar.geometry.bin_size_m();
  return std::clamp(8 * static_cast<int>(std::ceil(arc_bins / bins_per_row / 8.0)), 16, max_elevation_rays);
}

int choose_rays_per_beam(const SonarModel& sonar) {
  if (sonar.rays.azimuth_rays_per_beam > 0) return sonar.rays.azimuth_rays_per_beam;
  const std::vector<double> edges = sonar.geometry.beam_edges_rad();
  double widest = 0.0;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) widest = std::max(widest, edges[b] - edges[b + 1]);
  return std::clamp(static_cast<int>(std::ceil(widest / (0.5 * sonar.receive_azimuth.width_rad()) - 1e-9)), 1, 64);
}

}  // namespace

RayFan::RayFan(const SonarModel& sonar) {
  const double half_arc = std::asin(sonar.elevation.sine_beyond_db(0.5 * least_two_way_db));
  elevation_rays = choose_elevation_rays(sonar, half_arc);
  const double step = 2.0 * half_arc / elevation_rays;
  for (int i = 0; i <= elevation_rays; ++i) {
    cos_edge.push_back(static_cast<float>(std::cos(-half_arc + i * step)));
    sin_edge.push_back(static_cast<float>(std::sin(-half_arc + i * step)));
  }
  const double half_fov = 0.5 * sonar.geometry.elevation_fov_rad;
  first_nominal_row = elevation_rays;
  for (int i = 0; i < elevation_rays; ++i) {
    const double phi = -half_arc + (i + 0.5) * step;
    const double pattern = sonar.elevation.power(std::sin(phi));
    elevation_rad.push_back(static_cast<float>(phi));
    cos_elevation.push_back(static_cast<float>(std::cos(phi)));
    sin_elevation.push_back(static_cast<float>(std::sin(phi)));
    row_gain.push_back(static_cast<float>(pattern * pattern * std::cos(phi) * step));
    if (std::abs(phi) <= half_fov) {
      first_nominal_row = std::min(first_nominal_row, i);
      last_nominal_row = i + 1;
    }
  }

  rays_per_beam = choose_rays_per_beam(sonar);
  const std::vector<double> edges = sonar.geometry.beam_edges_rad();
  const double fan_edge = std::max(std::abs(edges.front()), std::abs(edges.back()));
  for (int b = 0; b < sonar.geometry.beams(); ++b) {
    // A lone beam has no neighbours to share the fan with: it is as wide as its pattern.
    const double cell = edges.size() > 2 ? edges[b] - edges[b + 1] : sonar.receive_azimuth.width_rad();
    const double start = edges.size() > 2 ? edges[b] : edges[b] + 0.5 * cell;
    for (int k = 0; k < rays_per_beam; ++k) {
      const double theta = start - (k + 0.5) * cell / rays_per_beam;
      const double off_axis = fan_edge > 0.0 ? theta / fan_edge : 0.0;
      columns.push_back({static_cast<float>(theta), static_cast<float>(std::cos(theta)),
                         static_cast<float>(std::sin(theta)), static_cast<float>(cell / rays_per_beam),
                         static_cast<float>(std::pow(10.0, -0.1 * sonar.fan_edge_db * off_axis * off_axis))});
    }
  }
}

}  // namespace ensonify
