#include "ensonify/generators/lawnmower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

using Eigen::Vector2d;
constexpr double pi = std::numbers::pi;
constexpr int max_lanes = 10'000;

/// Where the line through `point` along `direction` enters and leaves the box, which it meets.
Lane across(const Eigen::AlignedBox2d& box, const Vector2d& point, const Vector2d& direction) {
  double enter = -1e18;
  double leave = 1e18;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(direction[axis]) < 1e-12) continue;
    const double a = (box.min()[axis] - point[axis]) / direction[axis];
    const double b = (box.max()[axis] - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {point + enter * direction, point + std::max(enter, leave) * direction};
}

double extent_along(const Eigen::AlignedBox2d& box, const Vector2d& direction) {
  return box.sizes().dot(direction.cwiseAbs());
}

}  // namespace

std::vector<Lane> survey_lanes(const Lawnmower& mow, const Eigen::AlignedBox2d& area_m) {
  const double heading = radians(mow.heading_deg);
  const Vector2d along(std::cos(heading), std::sin(heading));
  const Vector2d aside(-along.y(), along.x());
  const double extent_m = extent_along(area_m, aside);
  const double wanted = std::max(1.0, std::ceil(extent_m / mow.spacing_m - 1e-9));
  if (wanted > max_lanes) {
    throw ConfigError(
        fmt::format("spacing_m {} gives {:.0f} lanes, more than {}; widen it", mow.spacing_m, wanted, max_lanes));
  }
  const int lanes = static_cast<int>(wanted);
  std::vector<Lane> result;
  for (int i = 0; i < lanes; ++i) {
    const double offset_m = extent_m * ((i + 0.5) / lanes - 0.5);
    Lane lane = across(area_m, area_m.center() + offset_m * aside, along);
    if (i % 2 == 1) std::swap(lane.from_m, lane.to_m);
    result.push_back(lane);
  }
  return result;
}

SmoothedWay survey_way(const Lawnmower& mow, const Eigen::AlignedBox2d& area_m, double rounding_m) {
  const std::vector<Lane> lanes = survey_lanes(mow, area_m);
  std::vector<Leg> out;
  const auto swim = [&](const Vector2d& by_m) {
    Leg leg{by_m.norm(), PoseVector::Zero()};
    leg.change.head<2>() = by_m;
    out.push_back(leg);
  };
  const auto turn = [](double angle, double over_m) {
    Leg leg{over_m, PoseVector::Zero()};
    leg.change[5] = angle;
    return leg;
  };
  double yaw = radians(mow.heading_deg);
  const auto face = [&](double to) {
    const double angle = std::remainder(to - yaw, 2.0 * pi);
    out.push_back(turn(angle, 0.0));
    yaw += angle;
  };
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (i > 0) {
      const Vector2d over = lanes[i].from_m - lanes[i - 1].to_m;
      face(std::atan2(over.y(), over.x()));
      swim(over);
      face(radians(mow.heading_deg) + (i % 2 == 1 ? pi : 0.0));
    }
    swim(lanes[i].to_m - lanes[i].from_m);
  }
  const Leg about = turn(pi, pi * rounding_m);
  // Half of a rest before the first lane and half behind the last: the way begins at rest, on its heading.
  const Leg rest = turn(0.0, rounding_m);
  std::vector<Leg> legs{rest};
  legs.insert(legs.end(), out.begin(), out.end());
  legs.push_back(about);
  for (auto leg = out.rbegin(); leg != out.rend(); ++leg) legs.push_back({leg->length_m, -leg->change});
  // The way back undoes all turns, so that the two about add up to one whole turn.
  legs.push_back(about);
  legs.push_back(rest);
  PoseVector start;
  start << lanes.front().from_m, -mow.depth_m, 0.0, radians(mow.pitch_deg), radians(mow.heading_deg);
  return SmoothedWay(start, std::move(legs), rounding_m);
}

}  // namespace ensonify
