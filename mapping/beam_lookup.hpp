#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// A stand-in for atan2(y, x) that needs one division: grows with the angle, from -2 to 2 over a turn, and is 0
/// forward. NaN at the origin.
inline float turn_of(float x, float y) {
  const float q = y / (std::abs(x) + std::abs(y));
  return x >= 0 ? q : std::copysign(2.0F, y) - q;
}

/// Finds the beam of a direction in a table, for any spacing of beams: cells of the table are narrower than beams, so
/// that at most one border lies in each.
struct BeamLookup {
  std::vector<std::int32_t> beam;  ///< beam at the port side of a cell of the table, port to starboard
  std::vector<float> edge;         ///< borders of beams (turn_of), descending: beam b has edge[b] >= turn > edge[b + 1]
  float scale = 0;                 ///< cells of the table for a unit of turn_of

  explicit BeamLookup(const SonarGeometry& geometry);

  /// -1 outside the fan.
  int beam_at(float turn) const {
    if (!(turn <= edge.front() && turn > edge.back())) return -1;
    const float place = (edge.front() - turn) * scale;
    const int b = beam[std::min(static_cast<std::size_t>(place), beam.size() - 1)];
    return b + (turn <= edge[static_cast<std::size_t>(b) + 1] ? 1 : 0) -
           (turn > edge[static_cast<std::size_t>(b)] ? 1 : 0);
  }
};

}  // namespace ensonify
