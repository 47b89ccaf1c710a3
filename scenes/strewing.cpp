#include "ensonify/scenes/strewing.hpp"

#include <algorithm>
#include <limits>

namespace ensonify {

double distance_to_path_m(const Vec3& p, const std::vector<Vec3>& path_m) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    const Vec3& a = path_m[i];
    const Vec3 d = path_m[std::min(i + 1, path_m.size() - 1)] - a;
    const double t = d.squaredNorm() > 0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (p - a - t * d).norm());
  }
  return nearest;
}

Eigen::Quaterniond random_rotation(RandomSequence& random) {
  Eigen::Vector4d q;  // four normals point evenly over the unit quaternions
  for (int i = 0; i < 4; ++i) q[i] = random.normal();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

std::optional<Vec3> Strewer::place(RandomSequence& random, double radius_m, double reach_m, double lift_m) {
  constexpr int tries = 40;
  for (int attempt = 0; attempt < tries; ++attempt) {
    const double x = random.uniform(area_.area_m.min().x(), area_.area_m.max().x());
    const double y = random.uniform(area_.area_m.min().y(), area_.area_m.max().y());
    const Vec3 centre(x, y, ground_.height_m(x, y) + lift_m);
    if (distance_to_path_m(centre, ground_.path_m) < reach_m + area_.path_clearance_m) continue;
    const auto collides = [&](const Placed& other) {
      return (other.centre_m - centre).norm() < other.radius_m + radius_m;
    };
    if (!area_.overlap && std::any_of(placed_.begin(), placed_.end(), collides)) continue;
    placed_.push_back({centre, radius_m});
    return centre;
  }
  return std::nullopt;
}

}  // namespace ensonify
