#include "ensonify/scenes/lattice.hpp"

#include <array>
#include <utility>

namespace ensonify {
namespace {

using Corners = std::array<Vec3, 4>;

/// Where the legs stand at a height.
Corners corners_at(const Jacket& jacket, double z_m) {
  const double share = z_m / jacket.height_m;
  const double half_m = 0.5 * ((1 - share) * jacket.base_width_m + share * jacket.top_width_m);
  return {Vec3(half_m, half_m, z_m), Vec3(-half_m, half_m, z_m), Vec3(-half_m, -half_m, z_m),
          Vec3(half_m, -half_m, z_m)};
}

/// Sleeves beside a foot, one along each side of the base, outside the legs.
void add_foot_piles(const Jacket& jacket, const Vec3& foot, std::vector<Member>& members) {
  const double away_m = jacket.leg_radius_m + 1.6 * jacket.pile_radius_m;
  for (const Vec3& side : {Vec3(foot.x() > 0 ? 1 : -1, 0, 0), Vec3(0, foot.y() > 0 ? 1 : -1, 0)}) {
    const Vec3 middle = foot + away_m * side;
    const Vec3 half = Vec3(0, 0, jacket.pile_length_m);
    members.push_back({middle - half, middle + half, jacket.pile_radius_m});
    for (const double share : {0.25, 0.75}) {
      const Vec3 up = share * half;
      members.push_back({foot + up, middle + up, 0.6 * jacket.pile_radius_m});
    }
  }
}

}  // namespace

std::vector<Member> truss_members(const Truss& truss) {
  using Line = Eigen::Vector2d;  // y, z of a chord
  const double half_m = 0.5 * truss.width_m;
  const std::vector<Line> chords =
      truss.triangular
          ? std::vector<Line>{{-half_m, 0}, {half_m, 0}, {0, truss.height_m}}
          : std::vector<Line>{{-half_m, 0}, {half_m, 0}, {half_m, truss.height_m}, {-half_m, truss.height_m}};
  const auto node = [&](int bay, std::size_t chord) {
    const Line& line = chords[chord % chords.size()];
    return Vec3(truss.length_m * bay / truss.bays, line.x(), line.y());
  };
  std::vector<Member> members;
  for (std::size_t c = 0; c < chords.size(); ++c) {
    members.push_back({node(0, c), node(truss.bays, c), truss.chord_radius_m});
    for (int bay = 0; bay <= truss.bays; ++bay) {
      members.push_back({node(bay, c), node(bay, c + 1), truss.brace_radius_m});
      if (bay == truss.bays) break;
      const int lean = bay % 2;  // diagonals zigzag along a face
      members.push_back({node(bay + lean, c), node(bay + 1 - lean, c + 1), truss.brace_radius_m});
    }
  }
  return members;
}

std::vector<Member> jacket_members(const Jacket& jacket) {
  std::vector<Member> members;
  const Corners feet = corners_at(jacket, 0), heads = corners_at(jacket, jacket.height_m);
  for (std::size_t leg = 0; leg < 4; ++leg) members.push_back({feet[leg], heads[leg], jacket.leg_radius_m});

  // Framing stands a little clear of the ground and of the heads.
  const double low_m = 0.04 * jacket.height_m, high_m = 0.97 * jacket.height_m;
  for (int level = 0; level <= jacket.levels; ++level) {
    const double z_m = low_m + (high_m - low_m) * level / jacket.levels;
    const double next_m = low_m + (high_m - low_m) * (level + 1) / jacket.levels;
    const Corners here = corners_at(jacket, z_m), above = corners_at(jacket, next_m);
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t b = (a + 1) % 4;
      members.push_back({here[a], here[b], jacket.brace_radius_m});
      if (level == jacket.levels) continue;
      if (jacket.k_braces) {
        const Vec3 middle = 0.5 * (above[a] + above[b]);
        members.push_back({here[a], middle, jacket.brace_radius_m});
        members.push_back({here[b], middle, jacket.brace_radius_m});
      } else {
        members.push_back({here[a], above[b], jacket.brace_radius_m});
        members.push_back({here[b], above[a], jacket.brace_radius_m});
      }
    }
  }
  if (jacket.pile_radius_m > 0) {
    for (const Vec3& foot : feet) add_foot_piles(jacket, foot, members);
  }
  return members;
}

}  // namespace ensonify
