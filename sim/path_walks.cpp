#include "ensonify/sim/path_walks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ensonify/sim/path_pair.hpp"

namespace ensonify {
namespace {

using Vec = Eigen::Vector3f;
using bistatic::Scattered;

/// Extent (half length) of a path over three surfaces, in lengths of its way between the surfaces.
constexpr float third_order_smear = 0.05f;
constexpr float grazing = 1e-3f;

float fraction(float x) { return x - std::floor(x); }
SurfaceLaw law_of(const PathPoints& p, int l) { return {p.mu[l], p.specular[l], p.exponent[l], p.lobe_share[l]}; }
Vec normal_of(const PathPoints& p, int l) { return {p.nx[l], p.ny[l], p.nz[l]}; }
Vec unit_of(const PathPoints& p, int l) { return {p.dx[l], p.dy[l], p.dz[l]}; }

/// Three numbers in 0..1 that turn into a direction.
struct Choice {
  float kind, along, turn;
  Choice walk(int w) const {
    const auto k = static_cast<float>(w);
    return {fraction(kind + k / walks_per_point), fraction(along + k * 0.618034f), fraction(turn + k * 0.754878f)};
  }
  /// The low digits, which have nothing to do with the high ones.
  Choice next() const { return {fraction(1024.0f * kind), fraction(1024.0f * along), fraction(1024.0f * turn)}; }
};

/// A direction with the density `bistatic::scatter` gives; below the surface at times, where nothing is sent.
/// `in`: unit, to where the sound comes from.
Vec sample_direction(const SurfaceLaw& law, const Vec& n, const Vec& in, const Choice& choice) {
  const Vec u = n.unitOrthogonal();
  const float angle = static_cast<float>(2.0 * std::numbers::pi) * choice.turn;
  const Vec aside = std::cos(angle) * u + std::sin(angle) * n.cross(u);
  const float along = std::clamp(choice.along, 1e-6f, 1.0f - 1e-6f);
  if (choice.kind >= law.lobe_share) return std::sqrt(along) * n + std::sqrt(1.0f - along) * aside;
  const float cosine = bistatic::exp2_of(bistatic::log2_of(along) / (law.exponent + 1.0f));
  const Vec h = cosine * n + std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)) * aside;
  return 2.0f * in.dot(h) * h - in;
}

/// Eight walks that left the points of a packet.
struct Walkers {
  RayPacket rays;
  std::array<Vec, packet_lanes> normal;     ///< where they are, on the side they came from
  std::array<int, packet_lanes> surface{};  ///< index into RayScene::surfaces
  std::array<float, packet_lanes> length_m{};
  std::array<float, packet_lanes> passed{};  ///< what the surfaces pass on, over the density of the choices
};

/// Sends a lane out of a place. `scale`: what its surface passes on, over sigma / pdf. A walk's last step need not go
/// beyond the fan, where nothing sees its end.
void leave(const PathView& view, Walkers& walkers, int l, bool last, const SurfaceLaw& law, const Vec& place,
           const Vec& n, const Vec& in, const Choice& choice, float scale) {
  const Vec out = sample_direction(law, n, in, choice);
  const float cos_in = n.dot(in);
  const float cos_out = n.dot(out);
  walkers.rays.valid[l] = cos_in > grazing && cos_out > grazing;
  if (!walkers.rays.valid[l]) return;
  const Scattered sent = bistatic::scatter(law, cos_in, cos_out, in.dot(out));
  walkers.rays.origin[l] = place;
  walkers.rays.direction[l] = out;
  walkers.passed[l] = scale * sent.sigma / sent.pdf;
  walkers.rays.reach_m[l] = view.reach_m;
  if (!last) return;
  const auto in_sonar = [&](const Vec& v) {
    return Vec(v.dot(view.axes.forward), v.dot(view.axes.left), v.dot(view.axes.up));
  };
  const float within = view.fan.distance_within(in_sonar(place - view.axes.origin), in_sonar(out));
  walkers.rays.reach_m[l] = std::min(view.reach_m, 1.01f * within + lift_m);
}

/// Casts the walkers on; gives the places where the sonar sees them.
std::array<bool, packet_lanes> arrive(const PathView& view, Walkers& walkers, PathPoints& ends) {
  RayPacket& rays = walkers.rays;
  RayPacket to_sonar;
  const auto met = rays.intersect(view.scene, false);
  for (int l = 0; l < packet_lanes; ++l) {
    clear_point(ends, l);
    rays.valid[l] = rays.valid[l] && met[l].surface >= 0;
    if (!rays.valid[l]) continue;
    const Vec& n = met[l].normal;
    walkers.normal[l] = n.dot(rays.direction[l]) < 0.0f ? n : Vec(-n);
    walkers.surface[l] = met[l].surface;
    walkers.length_m[l] += met[l].distance_m;
    rays.origin[l] += met[l].distance_m * rays.direction[l] + lift_m * walkers.normal[l];
    const Vec from_sonar = rays.origin[l] - view.axes.origin;
    const float r = from_sonar.norm();
    if (!(r > grazing) || from_sonar.dot(walkers.normal[l]) >= 0.0f) continue;  // its other side
    to_sonar.valid[l] = set_point(ends, l, view, from_sonar / r, r, n, met[l].surface);
    to_sonar.origin[l] = rays.origin[l];
    to_sonar.direction[l] = -from_sonar;
  }
  const auto blocked = to_sonar.occluded(view.scene);
  std::array<bool, packet_lanes> seen{};
  for (int l = 0; l < packet_lanes; ++l) seen[l] = to_sonar.valid[l] && !blocked[l];
  return seen;
}

/// The path over three surfaces that ends here. Half of it: it is found from its other end as well.
PathPair third_order(const Walkers& walkers, const PathPoints& start, const PathPoints& ends, int l) {
  const Vec back = -walkers.rays.direction[l];
  const float cos_in = std::max(walkers.normal[l].dot(back), grazing);
  const float r = ends.range_m[l];
  const Scattered sent = bistatic::scatter(law_of(ends, l), ends.cos_sonar[l], cos_in, -unit_of(ends, l).dot(back));
  const float one_way = ends.send[l] * ends.cos_sonar[l];
  return {0.5f * walkers.passed[l] * sent.sigma / cos_in * one_way / (r * r),
          0.5f * (start.range_m[l] + walkers.length_m[l] + r), third_order_smear * walkers.length_m[l]};
}

/// give(path, start, ends, lane) for every path found.
template <typename Give>
void walk(const PathView& view, const PathHits& hits, int walks, int order, bool joining, const Give& give) {
  const auto& tiles = view.tiles.tiles();
  Walkers walkers;
  PathPoints ends;
  for (int block = 0; block < hits.blocks; ++block) {
    for (int step = 0; step < PathTiles::points * walks; ++step) {
      const int q = step / walks;
      const PathPoints& start = hits.of(block, q);
      std::array<Choice, packet_lanes> choice;
      for (int l = 0; l < packet_lanes; ++l) {
        walkers.rays.valid[l] = false;
        if (!(start.send[l] > 0.0f)) continue;
        const PathTiles::Point point = view.tiles.point(tiles[block * packet_lanes + l], q);
        choice[l] = Choice{point.kind, point.along, point.turn}.walk(step % walks);
        walkers.length_m[l] = 0.0f;
        leave(view, walkers, l, order == 2, law_of(start, l), lifted(start, l, view.axes), normal_of(start, l),
              -unit_of(start, l), choice[l], start.send[l] / (static_cast<float>(walks) * start.density[l]));
      }
      for (int bounce = 2; bounce <= order; ++bounce) {
        const std::array<bool, packet_lanes> seen = arrive(view, walkers, ends);
        for (int l = 0; l < packet_lanes; ++l) {
          if (!seen[l]) continue;
          give(bounce == 2 ? path_pair(ends, l, start, l, joining) : third_order(walkers, start, ends, l), start, ends,
               l);
        }
        for (int l = 0; l < packet_lanes && bounce < order; ++l) {
          if (!walkers.rays.valid[l]) continue;
          const Vec back = -walkers.rays.direction[l];
          choice[l] = choice[l].next();
          const int material = view.scene.surfaces()[walkers.surface[l]].material;
          leave(view, walkers, l, bounce + 1 == order, view.scene.laws()[material], walkers.rays.origin[l],
                walkers.normal[l], back, choice[l], walkers.passed[l] / std::max(walkers.normal[l].dot(back), grazing));
        }
      }
    }
  }
}

}  // namespace

void add_walked_paths(const PathView& view, const PathHits& hits, int order, PathImage& image) {
  walk(view, hits, walks_per_point, order, true,
       [&](const PathPair& path, const PathPoints& start, const PathPoints& ends, int l) {
         image.add(start.column[l], image.box(path.half_length_m, path.extent_m, start.range_m[l], path.energy));
         image.add(ends.column[l], image.box(path.half_length_m, path.extent_m, ends.range_m[l], path.energy));
       });
}

std::vector<float> walked_energy(const PathView& view, const PathHits& hits) {
  std::vector<float> energy(static_cast<std::size_t>(view.tiles.grid().cells()), 0.0f);
  walk(view, hits, 1, 2, false, [&](const PathPair& path, const PathPoints& start, const PathPoints& ends, int l) {
    energy[start.cell[l]] += path.energy;
    energy[ends.cell[l]] += path.energy;
  });
  return energy;
}

}  // namespace ensonify
