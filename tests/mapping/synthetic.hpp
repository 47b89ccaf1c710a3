#pragma once

#include <cmath>
#include <functional>
#include <limits>

#include "ensonify/core/posed_image.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify::test {

inline SonarGeometry sonar(double width_deg, double height_deg, double range_max_m, int bins = 200, int beams = 96,
                           double range_min_m = 0.2) {
  SonarGeometry g;
  g.range_min_m = range_min_m;
  g.range_max_m = range_max_m;
  g.range_bins = bins;
  for (int b = 0; b < beams; ++b) g.beam_azimuth_rad.push_back(radians(width_deg) * (0.5 - (b + 0.5) / beams));
  g.elevation_fov_rad = radians(height_deg);
  return g;
}

/// The image of surfaces that echo with grey level 200 wherever a ray first meets them: `range_m(origin, direction)`.
/// The elevation of a pixel is that of its ray nearest to 0.
inline PosedImage image_of(const SonarGeometry& g, const Pose& pose,
                           const std::function<double(const Vec3&, const Vec3&)>& range_m, int elevations = 121) {
  PosedImage ping{Image2<std::uint8_t>(g.range_bins, g.beams()), g, pose,
                  Image2<float>(g.range_bins, g.beams(), std::numeric_limits<float>::quiet_NaN())};
  auto& grey = std::get<Image2<std::uint8_t>>(ping.grey);
  for (int b = 0; b < g.beams(); ++b) {
    for (int e = 0; e < elevations; ++e) {
      const double elevation = g.elevation_fov_rad * ((e + 0.5) / elevations - 0.5);
      const Vec3 ray = pose.linear() * from_spherical({1, g.beam_azimuth_rad[static_cast<std::size_t>(b)], elevation});
      const auto bin = g.bin_of(range_m(pose.translation(), ray));
      if (!bin) continue;
      grey(*bin, b) = 200;
      float& known = ping.elevation_rad(*bin, b);
      if (!(std::abs(known) <= std::abs(static_cast<float>(elevation)))) known = static_cast<float>(elevation);
    }
  }
  return ping;
}

/// Levels drawn on 0..80, with every tenth pixel strong.
inline PosedImage noise_image(const SonarGeometry& g, const Pose& pose, std::uint64_t seed) {
  PosedImage ping{Image2<std::uint8_t>(g.range_bins, g.beams()), g, pose,
                  Image2<float>(g.range_bins, g.beams(), std::numeric_limits<float>::quiet_NaN())};
  RandomSequence random(RandomKey::from_seed(seed));
  auto& grey = std::get<Image2<std::uint8_t>>(ping.grey);
  for (auto& z : grey.pixels())
    z = static_cast<std::uint8_t>(random.uniform() < 0.002 ? 200 : 40 * std::pow(random.uniform(), 8));
  for (std::size_t i = 0; i < grey.size(); ++i) {
    if (random.uniform() < 0.05) {
      ping.elevation_rad.pixels()[i] = static_cast<float>(g.elevation_fov_rad * random.uniform(-0.5, 0.5));
    }
  }
  return ping;
}

inline GridFrame box_frame(const Vec3& low_m, const Vec3& high_m, double resolution_m) {
  GridFrame frame{.origin_m = low_m, .resolution_m = resolution_m};
  for (int a = 0; a < 3; ++a) frame.size[a] = static_cast<int>(std::lround((high_m[a] - low_m[a]) / resolution_m));
  return frame;
}

template <typename Visit>
void for_each_cell(const GridFrame& frame, const Visit& visit) {
  for (int z = 0; z < frame.size[2]; ++z) {
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = 0; x < frame.size[0]; ++x) visit(Cell{x, y, z});
    }
  }
}

/// Volume (m^3) of the cells whose value satisfies `is`.
inline double volume_m3(const LogOddsGrid& grid, const std::function<bool(MilliLogOdds)>& is) {
  std::size_t cells = 0;
  for_each_cell(grid.frame(), [&](const Cell& c) { cells += is(grid.at(c)); });
  return static_cast<double>(cells) * std::pow(grid.frame().resolution_m, 3);
}

inline bool is_free(MilliLogOdds v) { return v < 0; }
inline bool is_occupied(MilliLogOdds v) { return v > 0; }

inline bool same(const LogOddsGrid& a, const LogOddsGrid& b) {
  bool equal = a.frame().size == b.frame().size;
  for_each_cell(a.frame(), [&](const Cell& c) { equal &= a.at(c) == b.at(c); });
  return equal;
}

}  // namespace ensonify::test
