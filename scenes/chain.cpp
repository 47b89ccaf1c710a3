#include "ensonify/scenes/chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/scenes/loft.hpp"

namespace ensonify {

TriangleMesh make_chain_link(const ChainLink& link) {
  constexpr int half_bend = 8, around = 12;
  const double bend_m = 0.5 * link.width_m - link.wire_radius_m;
  const double straight_m = 0.5 * (link.length_m - link.width_m);
  std::vector<Ring> rings;
  for (const int side : {1, -1}) {
    for (int i = 0; i <= half_bend; ++i) {
      const double angle = std::numbers::pi * (static_cast<double>(i) / half_bend - 0.5);
      const Vec3 spoke(side * std::cos(angle), side * std::sin(angle), 0);
      Ring ring;
      for (int s = 0; s < around; ++s) {
        const double turn = 2 * std::numbers::pi * s / around;
        ring.push_back(Vec3(side * straight_m, 0, 0) + (bend_m + link.wire_radius_m * std::cos(turn)) * spoke +
                       link.wire_radius_m * std::sin(turn) * Vec3::UnitZ());
      }
      rings.push_back(ring);
    }
  }
  return loft_loop(rings);
}

int chain_links(const ChainLink& link, const HangingLine& line) {
  return std::max(1, static_cast<int>(std::lround(line.length_m() / link.pitch_m())));
}

Assembly build_chain(const ChainLink& link, const HangingLine& line) {
  Assembly chain = assembly_of(make_chain_link(link));
  chain.parts.clear();
  const std::vector<Vec3> ends = line.points_m(chain_links(link, line));
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Vec3 span = ends[i + 1] - ends[i];
    const Vec3 along = span.normalized();
    Vec3 across = Vec3::UnitZ().cross(along);
    if (across.norm() < 1e-6) across = Vec3::UnitY();
    across.normalize();
    Eigen::Matrix3d turn;
    turn << along, across, along.cross(across);
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(0.5 * (ends[i] + ends[i + 1])).rotate(turn);
    // A quarter turn from link to link, half of it before, as a loaded chain hangs.
    T.rotate(Eigen::AngleAxisd((i % 2 == 0 ? 0.25 : -0.25) * std::numbers::pi, Vec3::UnitX()));
    T.scale(Vec3(span.norm() / link.pitch_m(), 1, 1));
    chain.parts.push_back({0, T});
  }
  return chain;
}

}  // namespace ensonify
