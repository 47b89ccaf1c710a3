#include "ensonify/generators/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/attitude_noise.hpp"
#include "ensonify/generators/lawnmower.hpp"
#include "ensonify/generators/object_outline.hpp"

namespace ensonify {
namespace {

using Way = std::variant<SmoothedWay, Circle, RecordedPath>;
constexpr double never = std::numeric_limits<double>::infinity();

SmoothedWay through(const std::vector<Pose>& waypoints, double rounding_m) {
  std::vector<PoseVector> knots;
  for (const Pose& pose : waypoints) knots.push_back(vector_of(pose));
  return there_and_back(unwrapped(std::move(knots)), rounding_m);
}

Eigen::AlignedBox2d survey_area(const Lawnmower& mow, const Scene& scene) {
  const auto flat = [](const Eigen::AlignedBox3d& box) {
    return Eigen::AlignedBox2d(box.min().head<2>(), box.max().head<2>());
  };
  const Eigen::AlignedBox2d area_m = mow.area_m.value_or(flat(scene.navigable_m));
  if (!flat(scene.bounds_m).contains(area_m)) {
    throw ConfigError(fmt::format("area must lie within the bounds of scene {}", scene.name));
  }
  return area_m;
}

Circle circle_of(const Orbit& orbit, const Scene& scene, double rounding_m) {
  const bool point = std::holds_alternative<Vec3>(orbit.about);
  const Vec3 aim =
      point ? std::get<Vec3>(orbit.about) : object_box_m(scene, std::get<std::string>(orbit.about)).center();
  const double turns = orbit.turns.value_or(1.0);
  PoseVector end = PoseVector::Zero();
  end[0] = 2.0 * std::numbers::pi * orbit.radius_m * turns;
  const PoseVector start = PoseVector::Zero();
  Circle circle{orbit.turns ? there_and_back({start, end}, rounding_m)
                            : SmoothedWay(start, {{end[0], end}}, std::min(rounding_m, 0.25 * end[0]))};
  circle.centre_m = {aim.x(), aim.y(), -orbit.depth_m};
  circle.radius_m = orbit.radius_m;
  circle.start_rad = radians(orbit.start_deg);
  circle.pitch_rad =
      orbit.pitch_deg ? radians(*orbit.pitch_deg) : std::atan2(circle.centre_m.z() - aim.z(), orbit.radius_m);
  circle.clockwise = orbit.clockwise;
  return circle;
}

Way way_of(const TrajectoryPoses& spec, const Scene& scene) {
  struct {
    const Scene& scene;
    double rounding_m;
    Way operator()(const SceneWaypoints&) const {
      if (scene.waypoints.empty()) {
        throw ConfigError(fmt::format("scene {}: has no waypoints, which a trajectory split needs", scene.name));
      }
      return through(scene.waypoints, rounding_m);
    }
    Way operator()(const OwnWaypoints& own) const { return through(own.T_world_sonar, rounding_m); }
    Way operator()(const Lawnmower& mow) const { return survey_way(mow, survey_area(mow, scene), rounding_m); }
    Way operator()(const Orbit& orbit) const { return circle_of(orbit, scene, rounding_m); }
    Way operator()(const WallFollow& wall) const { return wall_way(wall, scene, rounding_m); }
    Way operator()(const RecordedPath& recorded) const { return recorded; }
  } visitor{scene, spec.rounding_m};
  try {
    return std::visit(visitor, spec.path);
  } catch (const ConfigError& e) {
    throw ConfigError(spec.where.empty() ? e.what() : fmt::format("{}: {}", spec.where, e.what()));
  }
}

/// The piece of a record in which a time since its first pose lies, and when it begins and ends by the same clock.
struct Piece {
  const Pose& from;
  const Pose& to;
  double begin_s, end_s;
};

Piece piece_of(const std::vector<StampedPose>& poses, double time_s) {
  const double start_s = poses.front().time_s;
  const auto end = std::upper_bound(poses.begin() + 1, poses.end() - 1, time_s,
                                    [&](double t, const StampedPose& pose) { return t < pose.time_s - start_s; });
  const StampedPose& a = *(end - 1);
  return {a.T_world_sonar, end->T_world_sonar, a.time_s - start_s, end->time_s - start_s};
}

Pose pose_on(const SmoothedWay& way, double way_m) { return pose_of(way.at(way_m)); }

Pose pose_on(const Circle& circle, double way_m) {
  const double swum = circle.along.at(way_m)[0] / circle.radius_m;
  const double bearing = circle.start_rad + (circle.clockwise ? -swum : swum);
  const Vec3 outward(std::cos(bearing), std::sin(bearing), 0.0);
  return pose_from_xyz_rpy(circle.centre_m + circle.radius_m * outward, 0.0, circle.pitch_rad,
                           bearing + std::numbers::pi);
}

Pose pose_at(const RecordedPath& recorded, double time_s) {
  if (recorded.poses->size() == 1) return recorded.poses->front().T_world_sonar;
  const auto [from, to, begin_s, end_s] = piece_of(*recorded.poses, time_s);
  const double share = std::clamp((time_s - begin_s) / (end_s - begin_s), 0.0, 1.0);
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond(from.rotation()).slerp(share, Eigen::Quaterniond(to.rotation())).toRotationMatrix();
  pose.translation() = (1.0 - share) * from.translation() + share * to.translation();
  return pose;
}

}  // namespace

Trajectory::Trajectory(const TrajectoryPoses& spec, const Scene& scene, RandomKey key)
    : way_(way_of(spec, scene)), noise_(spec.attitude_noise), noise_key_(key.child("attitude_noise")) {
  if (std::holds_alternative<RecordedPath>(way_)) return;
  RandomSequence random(key.child("speed_mps"));
  speed_mps_ = sample(spec.speed_mps, random);
}

Pose Trajectory::path_at(double time_s) const {
  if (const auto* recorded = std::get_if<RecordedPath>(&way_)) return pose_at(*recorded, time_s);
  const double way_m = *speed_mps_ * time_s;
  if (const auto* circle = std::get_if<Circle>(&way_)) return pose_on(*circle, way_m);
  return pose_on(std::get<SmoothedWay>(way_), way_m);
}

Pose Trajectory::at(double time_s) const {
  Pose pose = path_at(time_s);
  const Vec3 rock = rocking_rad(noise_, noise_key_, time_s);
  if (!rock.isZero(0.0)) pose.linear() *= pose_from_xyz_rpy(Vec3::Zero(), rock.x(), rock.y(), rock.z()).linear();
  return pose;
}

double Trajectory::lasts_s() const {
  const auto* recorded = std::get_if<RecordedPath>(&way_);
  return recorded ? recorded->poses->back().time_s - recorded->poses->front().time_s : never;
}

double Trajectory::repeats_s() const {
  if (const auto* circle = std::get_if<Circle>(&way_)) return circle->along.period_m() / *speed_mps_;
  if (const auto* way = std::get_if<SmoothedWay>(&way_)) return way->period_m() / *speed_mps_;
  return never;
}

double Trajectory::next_look_s(double time_s, double step_m) const {
  if (speed_mps_) return time_s + step_m / *speed_mps_;
  const auto& poses = *std::get<RecordedPath>(way_).poses;
  if (poses.size() == 1) return never;
  const auto [from, to, begin_s, end_s] = piece_of(poses, time_s);
  const double way_m = (to.translation() - from.translation()).norm();
  const double next_s = way_m > 0.0 ? time_s + step_m / way_m * (end_s - begin_s) : never;
  if (end_s <= time_s) return never;
  return std::max(std::min(next_s, end_s), std::nextafter(time_s, never));
}

Twist twist_at(const Trajectory& trajectory, double time_s) {
  constexpr double half_step_s = 0.01;
  const double before_s = std::max(0.0, time_s - half_step_s);
  const double after_s = std::min(time_s + half_step_s, trajectory.lasts_s());
  const double step_s = after_s - before_s;
  if (!(step_s > 0.0)) return {};
  const Pose before = trajectory.at(before_s);
  const Pose after = trajectory.at(after_s);
  const Eigen::Matrix3d R = trajectory.at(time_s).linear();
  const Eigen::AngleAxisd turned(before.linear().transpose() * after.linear());
  return {R.transpose() * (after.translation() - before.translation()) / step_s,
          turned.angle() / step_s * turned.axis()};
}

Motion motion_of(const Trajectory& trajectory, double until_s) {
  constexpr double step_s = 0.05;
  constexpr double longest_s = 3600.0;
  Motion motion;
  const double end_s = std::min({until_s, longest_s, trajectory.lasts_s()});
  Pose last = trajectory.at(0.0);
  Vec3 last_velocity = Vec3::Zero();
  for (int i = 1; i * step_s <= end_s; ++i) {
    const Pose here = trajectory.at(i * step_s);
    const Vec3 velocity = (here.translation() - last.translation()) / step_s;
    const double turned = Eigen::AngleAxisd(last.linear().transpose() * here.linear()).angle();
    motion.length_m += velocity.norm() * step_s;
    motion.max_speed_mps = std::max(motion.max_speed_mps, velocity.norm());
    motion.max_turn_rate_radps = std::max(motion.max_turn_rate_radps, turned / step_s);
    if (i > 1) {
      motion.max_acceleration_mps2 = std::max(motion.max_acceleration_mps2, (velocity - last_velocity).norm() / step_s);
    }
    last = here;
    last_velocity = velocity;
  }
  return motion;
}

std::optional<Obstruction> first_obstruction(const Trajectory& trajectory, const OccupancyGrid& truth,
                                             double clearance_m, double until_s) {
  const double end_s = std::min({until_s, trajectory.lasts_s(), trajectory.repeats_s()});
  for (double time_s = 0.0;; time_s = std::min(end_s, trajectory.next_look_s(time_s, 0.5 * truth.frame.resolution_m))) {
    const Vec3 p_world = trajectory.path_at(time_s).translation();
    if (!has_room(truth, p_world, clearance_m)) return Obstruction{time_s, p_world};
    if (time_s >= end_s) return std::nullopt;
  }
}

}  // namespace ensonify
