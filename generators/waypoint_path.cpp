#include "ensonify/generators/waypoint_path.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {

WaypointPath::WaypointPath(std::vector<Pose> waypoints) : waypoints_(std::move(waypoints)) {
  for (std::size_t i = 0; i < waypoints_.size(); ++i) {
    const double leg_m = i == 0 ? 0.0 : (waypoints_[i].translation() - waypoints_[i - 1].translation()).norm();
    start_m_.push_back(i == 0 ? 0.0 : start_m_.back() + leg_m);
  }
  if (start_m_.empty() || start_m_.back() <= 0.0) {
    throw ConfigError("a trajectory needs at least two waypoints at different places");
  }
}

Pose WaypointPath::at(double travelled_m) const {
  const double way_and_back = std::fmod(travelled_m, 2.0 * length_m());
  const double way = way_and_back <= length_m() ? way_and_back : 2.0 * length_m() - way_and_back;
  const auto next = std::upper_bound(start_m_.begin() + 1, start_m_.end() - 1, way);
  const auto leg = static_cast<std::size_t>(next - start_m_.begin());
  const Pose& from = waypoints_[leg - 1];
  const Pose& to = waypoints_[leg];
  const double leg_m = start_m_[leg] - start_m_[leg - 1];
  const double share = leg_m > 0.0 ? (way - start_m_[leg - 1]) / leg_m : 0.0;
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond(from.rotation()).slerp(share, Eigen::Quaterniond(to.rotation())).toRotationMatrix();
  pose.translation() = (1.0 - share) * from.translation() + share * to.translation();
  return pose;
}

}  // namespace ensonify
