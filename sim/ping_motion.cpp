#include "ensonify/sim/ping_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ensonify {
namespace {

/// Row and column, in fractions of cells from the first cell's middle, where an echo arrives.
struct Arrival {
  double bin, beam;
};

class MovingReceiver {
 public:
  MovingReceiver(const SonarGeometry& geometry, const Twist& motion, double sound_speed_mps)
      : geometry_(geometry), motion_(motion), seconds_per_m_(2.0 / sound_speed_mps) {}

  Arrival arrival(int bin, int beam, double elevation_rad) const {
    const double r = geometry_.bin_centre_m(bin);
    const double t = r * seconds_per_m_;
    const Vec3 sent = from_spherical({r, geometry_.beam_azimuth_rad[static_cast<std::size_t>(beam)], elevation_rad});
    const Vec3 moved = sent - motion_.velocity_mps * t;
    const Spherical seen = to_spherical(moved - (motion_.turn_radps * t).cross(moved));
    const double half_path_m = 0.5 * (r + moved.norm());
    return {(half_path_m - geometry_.range_min_m) / geometry_.bin_size_m() - 0.5, beam_place(seen.azimuth_rad, beam)};
  }

 private:
  /// Between the centres of beams; outside of the fan a place beyond its last beam.
  double beam_place(double azimuth_rad, int near_beam) const {
    const auto& azimuth = geometry_.beam_azimuth_rad;
    const int last = geometry_.beams() - 1;
    if (last == 0) return 0.0;
    int b = std::min(near_beam, last - 1);
    while (b > 0 && azimuth_rad > azimuth[static_cast<std::size_t>(b)]) --b;
    while (b < last - 1 && azimuth_rad < azimuth[static_cast<std::size_t>(b) + 1]) ++b;
    const double left = azimuth[static_cast<std::size_t>(b)];
    return b + (left - azimuth_rad) / (left - azimuth[static_cast<std::size_t>(b) + 1]);
  }

  SonarGeometry geometry_;
  Twist motion_;
  double seconds_per_m_;
};

/// Calls give(bin, beam, share) for the cells within the image that a place lies between.
template <typename Give>
void share_out(const Arrival& at, const Image2<float>& image, const Give& give) {
  const double bin = std::floor(at.bin);
  const double beam = std::floor(at.beam);
  const std::array<double, 2> bin_share{1.0 - (at.bin - bin), at.bin - bin};
  const std::array<double, 2> beam_share{1.0 - (at.beam - beam), at.beam - beam};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const int row = static_cast<int>(bin) + i;
      const int column = static_cast<int>(beam) + j;
      if (row < 0 || row >= image.rows() || column < 0 || column >= image.columns()) continue;
      give(row, column, static_cast<float>(bin_share[i] * beam_share[j]));
    }
  }
}

}  // namespace

Echo receive_in_motion(const Echo& echo, const SonarGeometry& geometry, const Twist& motion, double sound_speed_mps) {
  if (motion.still()) return echo;
  const MovingReceiver receiver(geometry, motion, sound_speed_mps);
  const auto empty_like = [](const Image2<float>& image) { return Image2<float>(image.rows(), image.columns()); };
  Echo moved{empty_like(echo.direct), empty_like(echo.multipath), empty_like(echo.elevation_rad)};
  for (int bin = 0; bin < echo.direct.rows(); ++bin) {
    for (int beam = 0; beam < echo.direct.columns(); ++beam) {
      const float power = echo.direct(bin, beam);
      const float elevation = echo.elevation_rad.empty() ? 0.0f : echo.elevation_rad(bin, beam);
      if (power > 0.0f) {
        share_out(receiver.arrival(bin, beam, static_cast<double>(elevation)), echo.direct,
                  [&](int i, int j, float share) {
                    moved.direct(i, j) += share * power;
                    if (!moved.elevation_rad.empty()) moved.elevation_rad(i, j) += share * power * elevation;
                  });
      }
      if (!echo.multipath.empty() && echo.multipath(bin, beam) > 0.0f) {
        share_out(receiver.arrival(bin, beam, 0.0), echo.direct,
                  [&](int i, int j, float share) { moved.multipath(i, j) += share * echo.multipath(bin, beam); });
      }
    }
  }
  for (std::size_t i = 0; i < moved.elevation_rad.size(); ++i) {
    const float power = moved.direct.pixels()[i];
    float& elevation = moved.elevation_rad.pixels()[i];
    elevation = power > 0.0f ? elevation / power : 0.0f;
  }
  return moved;
}

}  // namespace ensonify
