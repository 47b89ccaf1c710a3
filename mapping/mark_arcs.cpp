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

/// Pixels of `lanes` cells in a row, from the centre of the first on; `outside` for none.
void pixels_of(const Projection& to, const std::array<float, 3>& p, const std::array<float, 3>& d,
               std::array<std::int32_t, lanes>& pixel) {
  const float* edge = to.lookup->edge.data();
  const std::int32_t* beam_at = to.lookup->beam.data();
  const float port = to.lookup->edge.front();
  const float starboard = to.lookup->edge.back();
  const float scale = to.lookup->scale;
  const float last_place = static_cast<float>(to.lookup->beam.size() - 1);
  std::array<float, lanes> turn, bin;
  std::array<std::int32_t, lanes> place, beam;
  for (int i = 0; i < lanes; ++i) {
    const float n = static_cast<float>(i);
    const float x = p[0] + n * d[0];
    const float y = p[1] + n * d[1];
    const float z = p[2] + n * d[2];
    const float flat2 = x * x + y * y;
    const float range = std::sqrt(flat2 + z * z);
    const float t = turn_of(x, y);
    const bool in = (range >= to.range_min_m) & (range < to.range_max_m) & (z * z <= to.tan2_elevation * flat2) &
                    (t <= port) & (t > starboard);
    turn[i] = t;
    const float b = (range - to.range_min_m) * to.bins_per_m;
    bin[i] = in ? std::min(b, to.last_bin) : -1.0F;
    const float c = (port - t) * scale;
    place[i] = static_cast<std::int32_t>(in ? std::min(c, last_place) : 0.0F);
  }
  for (int i = 0; i < lanes; ++i) beam[i] = beam_at[place[i]];
  for (int i = 0; i < lanes; ++i) {
    const std::int32_t b = beam[i] + (turn[i] <= edge[beam[i] + 1] ? 1 : 0) - (turn[i] > edge[beam[i]] ? 1 : 0);
    pixel[i] = bin[i] >= 0 ? static_cast<std::int32_t>(bin[i]) * to.beams + b : to.outside;
  }
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
      .outside = static_cast<std::int32_t>(evidence.mark.size() - 1),
  };
  const StridedBox& layout = marks.layout();
  const auto [low, high] = layout.box;
  const Pose T_sonar_world = frustum.T_world_sonar.inverse();
  const Vec3 step = frame.resolution_m * T_sonar_world.linear().col(0);
  parallel_for(high[2] - low[2], [&, low = low, high = high](int layer) {
    std::array<std::int32_t, lanes> pixel;
    const int z = low[2] + layer;
    for (int y = low[1]; y < high[1]; ++y) {
      const Vec3 start = T_sonar_world * frame.centre_m(0, y, z);
      const RowPieces pieces = pieces_in(frustum, start, step, low[0], high[0]);
      for (int k = 0; k < pieces.count; ++k) {
        const auto [from, end] = pieces.piece[static_cast<std::size_t>(k)];
        M* out = marks.data() + layout.offset({from, y, z});
        for (int x = from; x < end; x += lanes, out += lanes) {
          const Eigen::Vector3f p = (start + x * step).cast<float>();
          const Eigen::Vector3f d = step.cast<float>();
          pixels_of(to, {p.x(), p.y(), p.z()}, {d.x(), d.y(), d.z()}, pixel);
          const int n = std::min(lanes, end - x);
          for (int i = 0; i < n; ++i)
            out[i] = evidence.mark[static_cast<std::size_t>(pixel[static_cast<std::size_t>(i)])];
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
