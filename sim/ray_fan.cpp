#include "ensonify/sim/ray_fan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"
#include "ensonify/sensor_models/fan_pattern.hpp"

namespace ensonify {
namespace {

/// Where the mask of a bright surface may still reach (gamma 0.5 brings 60 dB into 8 bits): no edge of the fan shows.
constexpr double least_two_way_db = -60.0;
constexpr double bins_per_row = 3.0;
constexpr int packet = 8;
constexpr int max_elevation_rays = 8192;
/// A ping keeps the first hit of every ray: 256 MiB at most. The densest bundled instrument casts 0.2 million.
constexpr double max_rays = 1 << 26;
/// Heights of the rays within a step, in steps; neighbouring columns far apart.
constexpr std::array<double, RayFan::stagger> height_in_step{-0.375, 0.125, -0.125, 0.375};

int whole_packets(double rays) { return packet * static_cast<int>(std::ceil(rays / packet - 1e-9)); }

int choose_elevation_rays(const SonarModel& sonar, double half_arc) {
  if (sonar.rays.elevation_rays > 0) return whole_packets(sonar.rays.elevation_rays);
  const double arc_bins = 2.0 * half_arc * sonar.geometry.range_max_m / sonar.geometry.bin_size_m();
  return std::clamp(whole_packets(arc_bins / bins_per_row), 2 * packet, max_elevation_rays);
}

int choose_rays_per_beam(const SonarModel& sonar, const std::vector<double>& edges) {
  if (sonar.rays.azimuth_rays_per_beam > 0) return sonar.rays.azimuth_rays_per_beam;
  double widest = 0.0;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) widest = std::max(widest, edges[b] - edges[b + 1]);
  return std::clamp(static_cast<int>(std::ceil(widest / (0.5 * sonar.receive_azimuth.width_rad()) - 1e-9)), 1, 64);
}

/// Two-way pattern times the solid angle of a radian of elevation and azimuth.
double two_way_gain(const Aperture& elevation, double phi) {
  const double one_way = elevation.power(std::sin(phi));
  return one_way * one_way * std::cos(phi);
}

RayFan::Rows make_rows(const SonarModel& sonar, int rays, double half_arc, double height) {
  RayFan::Rows rows;
  const double step = 2.0 * half_arc / rays;
  const double lowest = -half_arc + height * step;
  const double half_fov = 0.5 * sonar.geometry.elevation_fov_rad;
  rows.first_nominal = rays;
  for (int i = 0; i <= rays; ++i) {
    rows.edge_cosine.push_back(static_cast<float>(std::cos(lowest + i * step)));
    rows.edge_sine.push_back(static_cast<float>(std::sin(lowest + i * step)));
  }
  for (int i = 0; i < rays; ++i) {
    const double phi = lowest + (i + 0.5) * step;
    rows.elevation_rad.push_back(static_cast<float>(phi));
    rows.cosine.push_back(static_cast<float>(std::cos(phi)));
    rows.sine.push_back(static_cast<float>(std::sin(phi)));
    // Simpson's rule: the flank of the main lobe falls by decibels within a step.
    const double below = two_way_gain(sonar.elevation, phi - 0.5 * step);
    const double above = two_way_gain(sonar.elevation, phi + 0.5 * step);
    const double mean = (below + 4.0 * two_way_gain(sonar.elevation, phi) + above) / 6.0;
    rows.gain.push_back(static_cast<float>(mean * step));
    rows.gain_slope.push_back(static_cast<float>(mean > 0.0 ? (above - below) / mean : 0.0));
    if (std::abs(phi) <= half_fov) {
      rows.first_nominal = std::min(rows.first_nominal, i);
      rows.last_nominal = i + 1;
    }
  }
  return rows;
}

}  // namespace

RayFan::RayFan(const SonarModel& sonar) {
  const double half_arc = std::asin(sonar.elevation.sine_beyond_db(0.5 * least_two_way_db));
  elevation_rays = choose_elevation_rays(sonar, half_arc);
  for (int s = 0; s < stagger; ++s) rows[s] = make_rows(sonar, elevation_rays, half_arc, height_in_step[s]);

  const std::vector<double> edges = sonar.geometry.beam_edges_rad();
  rays_per_beam = choose_rays_per_beam(sonar, edges);
  const double rays = 1.0 * sonar.geometry.beams() * rays_per_beam * elevation_rays;
  if (rays > max_rays) {
    throw ConfigError(
        fmt::format("sonar {}: {} beams of {} x {} rays are {:.0f} million rays a ping, more than {:.0f} "
                    "million; lower rays.azimuth_per_beam, rays.elevation or beams.count",
                    sonar.name, sonar.geometry.beams(), rays_per_beam, elevation_rays, rays * 1e-6, max_rays * 1e-6));
  }
  const FanPattern pattern(sonar);
  for (int b = 0; b < sonar.geometry.beams(); ++b) {
    // A lone beam has no neighbours to share the fan with: it is as wide as its pattern.
    const bool alone = sonar.geometry.beams() == 1;
    const double cell = alone ? sonar.receive_azimuth.width_rad() : edges[b] - edges[b + 1];
    const double port = alone ? edges[b] + 0.5 * cell : edges[b];
    for (int k = 0; k < rays_per_beam; ++k) {
      const double theta = port - (k + 0.5) * cell / rays_per_beam;
      columns.push_back({static_cast<float>(theta), static_cast<float>(std::cos(theta)),
                         static_cast<float>(std::sin(theta)), static_cast<float>(cell / rays_per_beam),
                         static_cast<float>(pattern(theta))});
    }
  }
}

}  // namespace ensonify
