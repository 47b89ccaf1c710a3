#include "ensonify/mapping/mark_arcs.hpp"

#include <array>

#include "ensonify/core/parallel.hpp"
#include "ensonify/mapping/beam_lookup.hpp"

namespace ensonify {
namespace {

constexpr int lanes = 64;

/// Numbers of the projection, in single precision.
struct Projection {
  float range_min_m, range_max_m, bins_per_m, last_bin, tan2_elevation;
  const BeamLookup* lookup;
  std::int32_t beams, outside;
};

/// Pixels of `lanes` cells in a row, from the centre of the first on; `outside` for none. Plain arrays and selections
/// without branches, so that the compiler makes vector code of the loops.
void pixels_of(const Projection& to, const Eigen::Vector3f& p, const Eigen::Vector3f& d, std::int32_t* pixel) {
  const float* const edge = to.lookup->edge.data();
  const std::int32_t* const beam_at = to.lookup->beam.data();
  const float port = to.lookup->edge.front();
  const float starboard = to.lookup->edge.back();
  const float scale = to.lookup->scale;
  const float last_place = static_cast<float>(to.lookup->beam.size() - 1);
  const auto [range_min, range_max, bins_per_m, last_bin, tan2] =
      std::array{to.range_min_m, to.range_max_m, to.bins_per_m, to.last_bin, to.tan2_elevation};
  const float x0 = p.x(), y0 = p.y(), z0 = p.z();
  const float dx = d.x(), dy = d.y(), dz = d.z();
  float turn[lanes], bin[lanes], place[lanes];
  for (int i = 0; i < lanes; ++i) {
    const float n = static_cast<float>(i);
    const float x = x0 + n * dx;
    const float y = y0 + n * dy;
    const float z = z0 + n * dz;
    const float flat2 = x * x + y * y;
    const float range = std::sqrt(flat2 + z * z);
    const float t = turn_of(x, y);
    const bool in =
        (range >= range_min) & (range < range_max) & (z * z <= tan2 * flat2) & (t <= port) & (t > starboard);
    const float b = (range - range_min) * bins_per_m;
    const float c = (port - t) * scale;
    turn[i] = t;
    bin[i] = in ? (b < last_bin ? b : last_bin) : -1.0F;
    place[i] = in ? (c < last_place ? c : last_place) : 0.0F;
  }
  std::int32_t beam[lanes];
  for (int i = 0; i < lanes; ++i) beam[i] = beam_at[static_cast<std::int32_t>(place[i])];
  for (int i = 0; i < lanes; ++i) {
    const std::int32_t b = beam[i] + (turn[i] <= edge[beam[i] + 1] ? 1 : 0) - (turn[i] > edge[beam[i]] ? 1 : 0);
    beam[i] = bin[i] >= 0 ? static_cast<std::int32_t>(bin[i]) * to.beams + b : to.outside;
  }
  for (int i = 0; i < lanes; ++i) pixel[i] = beam[i];
}

}  // namespace

template <typename M>
void mark_arcs(const EvidenceImage<M>& evidence, const SonarGeometry& geometry, const Frustum& frustum,
               const GridFrame& frame, MarkBox<M>& marks) {
  const BeamLookup lookup(geometry);
  const Projection to = {
      .range_min_m = static_cast<float>(geometry.range_min_m),
      .range_max_m = static_cast<float>(geometry.range_max_m),
      .bins_per_m = static_cast<float>(1 / geometry.bin_size_m()),
      .last_bin = static_cast<float>(geometry.range_bins - 1),
      .tan2_elevation = static_cast<float>(frustum.tan_elevation * frustum.tan_elevation),
      .lookup = &lookup,
      .beams = geometry.beams(),
      .outside = static_cast<std::int32_t>(evidence.size() - 1),
  };
  const StridedBox& layout = marks.layout();
  const auto [low, high] = layout.box;
  const Pose T_sonar_world = frustum.T_world_sonar.inverse();
  const Vec3 step = frame.resolution_m * T_sonar_world.linear().col(0);
  parallel_for(high[2] - low[2], [&, low = low, high = high](int layer) {
    std::int32_t pixel[lanes];
    const int z = low[2] + layer;
    for (int y = low[1]; y < high[1]; ++y) {
      const Vec3 start = T_sonar_world * frame.centre_m(0, y, z);
      const RowPieces pieces = pieces_in(frustum, start, step, low[0], high[0]);
      for (int k = 0; k < pieces.count; ++k) {
        const auto [from, end] = pieces.piece[static_cast<std::size_t>(k)];
        M* out = marks.data() + layout.offset({from, y, z});
        for (int x = from; x < end; x += lanes, out += lanes) {
          pixels_of(to, (start + x * step).cast<float>(), step.cast<float>(), pixel);
          const int n = std::min(lanes, end - x);
          for (int i = 0; i < n; ++i) out[i] = evidence[static_cast<std::size_t>(pixel[i])];
        }
      }
    }
  });
}

template void mark_arcs(const EvidenceImage<Mark>&, const SonarGeometry&, const Frustum&, const GridFrame&,
                        MarkBox<Mark>&);
template void mark_arcs(const EvidenceImage<SweepMark>&, const SonarGeometry&, const Frustum&, const GridFrame&,
                        MarkBox<SweepMark>&);

}  // namespace ensonify
