#include "ensonify/scenes/sheet_piles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/scenes/basic_shapes.hpp"
#include "ensonify/scenes/loft.hpp"

namespace ensonify {
namespace {

/// Outline of a strip of constant thickness about a polyline, with a bead at both ends: the interlock.
Polygon strip_outline(const Polygon& line, double thickness_m) {
  const double half_m = 0.5 * thickness_m;
  Polygon left, right;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d in = (line[i] - line[i > 0 ? i - 1 : 0]).normalized();
    const Eigen::Vector2d out = (line[std::min(i + 1, line.size() - 1)] - line[i]).normalized();
    const Eigen::Vector2d along = (in + out).normalized();
    const double widening = 1 / std::max(along.dot(i > 0 ? in : out), 0.5);
    const Eigen::Vector2d across = half_m * widening * Eigen::Vector2d(-along.y(), along.x());
    left.push_back(line[i] + across);
    right.push_back(line[i] - across);
  }
  // The bead reaches a thickness over the end and stands half a thickness proud on both sides.
  const auto add_bead = [&](Polygon& outline, const Eigen::Vector2d& end, const Eigen::Vector2d& along) {
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const auto& [forward, side] : {std::pair{-1.0, 1.0}, {1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}}) {
      outline.push_back(end + thickness_m * (forward * along + side * across));
    }
  };
  Polygon outline(left.begin() + 1, left.end() - 1);
  const Eigen::Vector2d last = (line.back() - line[line.size() - 2]).normalized();
  const Eigen::Vector2d first = (line.front() - line[1]).normalized();
  outline.push_back(line.back() - thickness_m * last + half_m * Eigen::Vector2d(-last.y(), last.x()));
  add_bead(outline, line.back(), last);
  outline.push_back(line.back() - thickness_m * last - half_m * Eigen::Vector2d(-last.y(), last.x()));
  outline.insert(outline.end(), right.rbegin() + 1, right.rend() - 1);
  outline.push_back(line.front() - thickness_m * first + half_m * Eigen::Vector2d(-first.y(), first.x()));
  add_bead(outline, line.front(), first);
  outline.push_back(line.front() - thickness_m * first - half_m * Eigen::Vector2d(-first.y(), first.x()));
  return outline;
}

/// Centre line of a pile from its left interlock to its right one, about x = 0.
Polygon pile_line(const SheetPileWall& wall) {
  const double half_pitch = 0.5 * wall.pitch_m, half_depth = 0.5 * (wall.depth_m - wall.thickness_m);
  if (wall.z_profile) {
    return {{-half_pitch, -half_depth},
            {-0.5 * half_pitch, -half_depth},
            {0.5 * half_pitch, half_depth},
            {half_pitch, half_depth}};
  }
  return {
      {-half_pitch, 0},       {-0.92 * half_pitch, 0}, {-0.5 * half_pitch, half_depth}, {0.5 * half_pitch, half_depth},
      {0.92 * half_pitch, 0}, {half_pitch, 0}};
}

}  // namespace

int sheet_piles(const SheetPileWall& wall) {
  return std::max(1, static_cast<int>(std::ceil(wall.length_m / wall.pitch_m - 1e-9)));
}

Assembly build_sheet_pile_wall(const SheetPileWall& wall, RandomKey key) {
  Assembly result =
      assembly_of(extrude(strip_outline(pile_line(wall), wall.thickness_m), -0.5 * wall.height_m, 0.5 * wall.height_m));
  result.parts.clear();
  const int piles = sheet_piles(wall);
  for (int i = 0; i < piles; ++i) {
    RandomSequence random(key.child(static_cast<std::uint64_t>(i)));
    const double y = sample(wall.offset_m, random), z = sample(wall.offset_m, random);
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(Vec3((i + 0.5) * wall.pitch_m, y, z - 0.5 * wall.height_m));
    if (i % 2 == 1) T.rotate(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
    result.parts.push_back({0, T});
  }
  if (wall.cap_height_m > 0) {
    const double length_m = piles * wall.pitch_m;
    Eigen::Affine3d T = Eigen::Affine3d::Identity();
    T.translate(Vec3(0.5 * length_m, 0, 0));  // half of it over the heads
    result.parts.push_back({static_cast<int>(result.meshes.size()), T});
    result.meshes.push_back(make_box({length_m, wall.cap_width_m, wall.cap_height_m}));
  }
  return result;
}

}  // namespace ensonify
