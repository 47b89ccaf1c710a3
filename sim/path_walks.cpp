#include "ensonify/sim/path_walks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/sim/path_pair.hpp"
#include "ensonify/sim/path_pairs.hpp"

namespace ensonify {
namespace {

using Vec = Eigen::Vector3f;

/// Smear (m of half length) of a walked path of order 3 over its length between the surfaces.
constexpr float third_order_smear = 0.05f;

/// The four numbers that turn into a direction.
struct Choice {
  float kind, along, turn_cosine, turn_sine;
};

/// A direction on the side of n in proportion to `bistatic::scatter`'s pdf; may point below the surface, where the lobe
/// does: then nothing is sent. `in`: unit, to where the sound comes from.
Vec sample_direction(const SurfaceLaw& law, const Vec& n, const Vec& in, const Choice& choice) {
  const Vec u = n.unitOrthogonal();
  const Vec v = n.cross(u);
  const Vec aside = choice.turn_cosine * u + choice.turn_sine * v;
  const float along = std::clamp(choice.along, 1e-6f, 1.0f - 1e-6f);
  if (choice.kind >= law.lobe_share) return std::sqrt(along) * n + std::sqrt(1.0f - along) * aside;
  const float cosine = bistatic::exp2_of(bistatic::log2_of(along) / (law.exponent + 1.0f));
  const Vec h = cosine * n + std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) * aside;
  return 2.0f * in.dot(h) * h - in;
}

SurfaceLaw law_of(const PathPoints& p, int l) { return {p.mu[l], p.specular[l], p.exponent[l], p.lobe_share[l]}; }
Vec normal_of(const PathPoints& p, int l) { return {p.nx[l], p.ny[l], p.nz[l]}; }
Vec unit_of(const PathPoints& p, int l) { return {p.dx[l], p.dy[l], p.dz[l]}; }
float fraction(float x) { return x - std::floor(x); }

constexpr float lift_m = 3e-4f;

/// Where a walk stands after it has left its first surface.
struct Walker {
  Vec place;   ///< world, lifted
  Vec normal;  ///< on the side it came from
  Vec back;    ///< unit, to where it came from
  int surface = -1;
  float length_m = 0;    ///< walked so far
  float throughput = 0;  ///< what the surfaces left so far pass on over the density of the choices
};

/// Puts a hit's place into a lane if the sonar may see it: inside of the fan, and on the side that the walk came from.
bool seen_point(PathPoints& points, int lane, const RayScene& scene, const PathFan& fan, const RayAxes& axes,
                const Walker& walker) {
  const Vec from_sonar = walker.place - axes.origin;
  const float r = from_sonar.norm();
  clear_point(points, lane);
  if (!(r > 1e-3f) || from_sonar.dot(walker.normal) >= 0.0f) return false;
  return set_point(points, lane, scene, fan, axes, from_sonar / r, r, walker.normal, walker.surface);
}

}  // namespace

void add_walked_paths(const RayScene& scene, const PathFan& fan, const PathHits& hits, const RayAxes& axes, int order,
                      float reach_m, PathImage& image) {
  RayPacket rays;
  RayPacket to_sonar;
  PathPoints ends;
  std::array<Walker, packet_lanes> walkers;
  for (int q = 0; q < PathFan::tile_columns; ++q) {
    for (int block = 0; block < hits.block_count; ++block) {
      const PathPoints& start = hits.of(q, block);
      const int first_tile = block % hits.block_columns * PathHits::block_tile_columns;
      const int first_row = block / hits.block_columns * PathHits::block_rows;
      const auto direction_of = [&](int l) -> const PathFan::Direction& {
        return fan.direction((first_tile + l / PathHits::block_rows) * PathFan::tile_columns + q,
                             first_row + l % PathHits::block_rows);
      };
      for (int l = 0; l < packet_lanes; ++l) {
        rays.valid[l] = false;
        if (!(start.send[l] > 0.0f)) continue;
        const PathFan::Direction& chosen = direction_of(l);
        const SurfaceLaw law = law_of(start, l);
        const Vec n = normal_of(start, l);
        const Vec in = -unit_of(start, l);
        const Vec out = sample_direction(law, n, in, {chosen.choice, chosen.along, chosen.turn_cosine, chosen.turn_sine});
        const float cos_out = n.dot(out);
        if (!(cos_out > 1e-3f)) continue;
        rays.valid[l] = true;
        rays.origin[l] = lifted(start, l, axes);
        rays.direction[l] = out;
        const bistatic::Scattered sent = bistatic::scatter(law, start.cos_sonar[l], cos_out, in.dot(out));
        walkers[l].throughput = start.send[l] * sent.sigma / (sent.pdf * start.density[l]);
        walkers[l].length_m = 0.0f;
      }
      for (int bounce = 2; bounce <= order; ++bounce) {
        const auto met = rays.intersect(scene, reach_m, false);
        for (int l = 0; l < packet_lanes; ++l) {
          to_sonar.valid[l] = false;
          rays.valid[l] = rays.valid[l] && met[l].surface >= 0;
          if (!rays.valid[l]) continue;
          Walker& walker = walkers[l];
          walker.back = -rays.direction[l];
          walker.normal = met[l].normal.dot(walker.back) > 0.0f ? met[l].normal : Vec(-met[l].normal);
          walker.place = rays.origin[l] + met[l].distance_m * rays.direction[l] + lift_m * walker.normal;
          walker.surface = met[l].surface;
          walker.length_m += met[l].distance_m;
          if (!seen_point(ends, l, scene, fan, axes, walker)) continue;
          to_sonar.valid[l] = true;
          to_sonar.origin[l] = walker.place;
          to_sonar.direction[l] = axes.origin - walker.place;
        }
        const auto blocked = to_sonar.occluded(scene);
        for (int l = 0; l < packet_lanes; ++l) {
          if (!to_sonar.valid[l] || blocked[l]) continue;
          PathPair path;
          if (bounce == 2) {
            path = path_pair(ends, l, start, l, joined_share);
          } else {
            const Walker& walker = walkers[l];
            const float cos_in = std::max(walker.normal.dot(walker.back), 1e-3f);
            const bistatic::Scattered sent =
                bistatic::scatter(law_of(ends, l), ends.cos_sonar[l], cos_in, -unit_of(ends, l).dot(walker.back));
            const float r = ends.range_m[l];
            // Half for either direction of travel: the other half of such paths is found from their other end.
            path = {0.5f * walker.throughput * sent.sigma / cos_in * ends.send[l] * ends.cos_sonar[l] / (r * r),
                    0.5f * (start.range_m[l] + walker.length_m + r), third_order_smear * walker.length_m};
          }
          image.add(start.column[l], path.half_length_m, path.extent_m, start.range_m[l], path.energy);
          image.add(ends.column[l], path.half_length_m, path.extent_m, ends.range_m[l], path.energy);
        }
        if (bounce == order) break;
        for (int l = 0; l < packet_lanes; ++l) {
          if (!rays.valid[l]) continue;
          Walker& walker = walkers[l];
          const PathFan::Direction& chosen = direction_of(l);
          const auto material = static_cast<std::size_t>(scene.surfaces()[static_cast<std::size_t>(walker.surface)].material);
          const SurfaceLaw& law = scene.laws()[material];
          const Choice next{fraction(chosen.choice + 0.5f), fraction(chosen.along + chosen.choice * 8.0f),
                            -chosen.turn_sine, chosen.turn_cosine};
          const Vec out = sample_direction(law, walker.normal, walker.back, next);
          const float cos_in = walker.normal.dot(walker.back);
          const float cos_out = walker.normal.dot(out);
          rays.valid[l] = cos_out > 1e-3f && cos_in > 1e-3f;
          if (!rays.valid[l]) continue;
          const bistatic::Scattered sent = bistatic::scatter(law, cos_in, cos_out, walker.back.dot(out));
          walker.throughput *= sent.sigma / (cos_in * sent.pdf);
          rays.origin[l] = walker.place;
          rays.direction[l] = out;
        }
      }
    }
  }
}

}  // namespace ensonify
