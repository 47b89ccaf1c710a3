#include "ensonify/mapping/beam_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr float most_table_cells = 1 << 20;

}  // namespace

BeamLookup::BeamLookup(const SonarGeometry& geometry) {
  for (const double a : geometry.beam_edges_rad()) {
    edge.push_back(turn_of(static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a))));
  }
  if (geometry.beams() == 1) {  // of no width, as far as a geometry tells: holds nothing
    beam = {0};
    return;
  }
  float narrowest = 4;
  for (std::size_t b = 0; b + 1 < edge.size(); ++b) narrowest = std::min(narrowest, edge[b] - edge[b + 1]);
  const float width = edge.front() - edge.back();
  if (!(narrowest > width / most_table_cells)) {
    throw DataError(
        fmt::format("beams of the image lie too close or out of order: the narrowest is {} of the fan's width; "
                    "azimuths must descend within one turn",
                    narrowest / width));
  }
  scale = 1.001F / narrowest;
  int b = 0;
  for (int i = 0; static_cast<float>(i) <= width * scale; ++i) {
    const float port_side = edge.front() - static_cast<float>(i) / scale;
    while (b + 1 < geometry.beams() && port_side <= edge[static_cast<std::size_t>(b) + 1]) ++b;
    beam.push_back(b);
  }
}

}  // namespace ensonify
