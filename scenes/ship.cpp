#include "ensonify/scenes/ship.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ensonify/scenes/ship_outfit.hpp"
#include "ensonify/scenes/ship_shell.hpp"
#include "ensonify/scenes/terrain.hpp"

namespace ensonify {
namespace {

constexpr int stations = 96;
constexpr double breaks_from = 0.5;

/// A hole torn into the plating.
struct Hole {
  Vec3 centre_m;
  double radius_m;
};

/// What has happened to a ship.
class Wreckage {
 public:
  Wreckage(const Ship& ship, const ShipShell& shell, RandomKey key) : key_(key) {
    RandomSequence random(key);
    broken_ = ship.damage >= breaks_from;
    cut_x_m_ = ship.length_m * random.uniform(-0.12, 0.16);
    gap_m_ = broken_ ? ship.length_m * 0.06 * ship.damage : 0;
    ragged_m_ = 0.05 * ship.length_m;
    depth_m_ = ship.depth_m;
    for (Eigen::Affine3d* T : {&T_aft_, &T_fore_}) {
      const double roll = radians(14) * ship.damage * random.uniform(-1, 1);
      const double yaw = radians(9) * ship.damage * random.uniform(-1, 1);
      const Vec3 pivot(cut_x_m_, 0, -ship.draft_m);
      *T = Eigen::Translation3d(pivot) * pose_from_xyz_rpy(Vec3::Zero(), roll, 0, yaw) * Eigen::Translation3d(-pivot);
    }
    const int holes = static_cast<int>(std::lround(14 * ship.damage));
    for (int i = 0; i < holes; ++i) {
      // Not at the stem, where the sides meet.
      const int station = 2 + random.below(stations - 8);
      const Vec3 centre = shell.cell_m(station, random.below(shell.points()));
      holes_.push_back({centre, ship.depth_m * random.uniform(0.1, 0.15 + 0.3 * ship.damage)});
    }
  }

  bool broken() const { return broken_; }

  bool in_hole(const Vec3& p) const {
    return std::any_of(holes_.begin(), holes_.end(), [&](const Hole& hole) {
      const double edge_m = hole.radius_m * (1 + 1.2 * gradient_noise(key_.child("edge"), p / hole.radius_m));
      return (p - hole.centre_m).norm() < edge_m;
    });
  }

  /// Which half a place belongs to: -1 aft, 1 fore, 0 lost where the hull broke.
  int half_at(const Vec3& p) const {
    if (!broken_) return -1;
    const Vec3 q(0.37, p.y() / (0.35 * depth_m_), p.z() / (0.35 * depth_m_));
    const double aft_m = cut_x_m_ - 0.5 * gap_m_ + ragged_m_ * gradient_noise(key_.child("aft"), q);
    const double fore_m = cut_x_m_ + 0.5 * gap_m_ + ragged_m_ * gradient_noise(key_.child("fore"), q);
    return p.x() < aft_m ? -1 : p.x() > fore_m ? 1 : 0;
  }

  Eigen::Affine3d T_half(int half) const {
    if (!broken_) return Eigen::Affine3d::Identity();
    return half < 0 ? T_aft_ : T_fore_;
  }

 private:
  RandomKey key_;
  bool broken_ = false;
  double cut_x_m_ = 0, gap_m_ = 0, ragged_m_ = 0, depth_m_ = 0;
  Eigen::Affine3d T_aft_ = Eigen::Affine3d::Identity(), T_fore_ = Eigen::Affine3d::Identity();
  std::vector<Hole> holes_;
};

bool opened(const std::vector<Hatch>& hatches, const Vec3& p) {
  return std::any_of(hatches.begin(), hatches.end(), [&](const Hatch& hatch) {
    return !hatch.covered && p.x() > hatch.from_x_m && p.x() < hatch.to_x_m;
  });
}

}  // namespace

Assembly build_ship(const Ship& ship, RandomKey key) {
  const ShipShell shell(ship, stations);
  const std::vector<Hatch> hatches = ship_hatches(ship, key);
  const Assembly outfit = ship_outfit(ship, hatches, key);
  const int shift = ship.damage >= breaks_from ? 2 : 1;  // meshes of the hull come first
  Assembly result;
  if (ship.damage <= 0) {
    result = assembly_of(shell.solid());
    for (const Part& part : outfit.parts) result.parts.push_back({part.mesh + shift, part.T_object_part});
  } else {
    const Wreckage wreckage(ship, shell, key.child("wreckage"));
    const double plate_m = std::max(0.05, 0.012 * ship.depth_m);
    for (const int half : wreckage.broken() ? std::vector<int>{-1, 1} : std::vector<int>{-1}) {
      const auto kept = [&](int station, int point) {
        const Vec3 p = shell.cell_m(station, point);
        if (wreckage.half_at(p) != half) return false;
        if (station >= stations - 3) return true;
        return !wreckage.in_hole(p) && !(shell.below_hatch(point) && opened(hatches, p));
      };
      result.parts.push_back({static_cast<int>(result.meshes.size()), wreckage.T_half(half)});
      result.meshes.push_back(shell.plates(kept, half < 0, plate_m));
    }
    for (const Part& part : outfit.parts) {
      const int half = wreckage.half_at(part.T_object_part.translation());
      if (half != 0) result.parts.push_back({part.mesh + shift, wreckage.T_half(half) * part.T_object_part});
    }
  }
  result.meshes.insert(result.meshes.end(), outfit.meshes.begin(), outfit.meshes.end());
  return result;
}

}  // namespace ensonify
