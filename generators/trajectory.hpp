#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "ensonify/core/random.hpp"
#include "ensonify/generators/place.hpp"
#include "ensonify/generators/smoothed_way.hpp"
#include "ensonify/generators/trajectory_spec.hpp"
#include "ensonify/sim/ping_motion.hpp"

namespace ensonify {

/// A level circle seen through a way along it: x of the way is the length swum along the circle.
struct Circle {
  SmoothedWay along;
  Vec3 centre_m = Vec3::Zero();  ///< z: of the circle
  double radius_m = 0;
  double start_rad = 0;
  double pitch_rad = 0;
  bool clockwise = false;
};

/// What a vehicle swims in one place: T_world_sonar at any time since the start, a pure function.
class Trajectory {
 public:
  /// Plans the way through the place; the keys of speed and rocking come from `key`. Throws ConfigError, which says
  /// where in the recipe, where the place has no such way.
  Trajectory(const TrajectoryPoses& spec, const Scene& scene, RandomKey key);

  /// time_s in [0, lasts_s()].
  Pose at(double time_s) const;
  /// The same without rocking.
  Pose path_at(double time_s) const;

  /// Infinite but for a recorded path.
  double lasts_s() const;
  /// After this time path_at begins anew; infinite for a recorded path.
  double repeats_s() const;
  /// The time at which path_at has gone on by at most `step_m` since `time_s`: for looking along the path.
  double next_look_s(double time_s, double step_m) const;
  /// Along straights; empty for a recorded path.
  std::optional<double> speed_mps() const { return speed_mps_; }

 private:
  std::variant<SmoothedWay, Circle, RecordedPath> way_;
  std::optional<double> speed_mps_;
  AttitudeNoise noise_;
  RandomKey noise_key_;
};

/// Velocity and turn rate at a time, in the sonar's frame: central differences over 20 ms, within what is swum.
Twist twist_at(const Trajectory& trajectory, double time_s);

/// How a trajectory moves, by differences over 0.05 s at 20 Hz over at most an hour: true poses, rocking included.
struct Motion {
  double length_m = 0;
  double max_speed_mps = 0;
  double max_acceleration_mps2 = 0;
  double max_turn_rate_radps = 0;
};
Motion motion_of(const Trajectory& trajectory, double until_s);

/// The first point of the path, within until_s, whose clearance touches something or leaves the truth's bounds; looked
/// for in steps of half a cell. Empty where all is free.
struct Obstruction {
  double time_s = 0;
  Vec3 p_world = Vec3::Zero();
};
std::optional<Obstruction> first_obstruction(const Trajectory& trajectory, const OccupancyGrid& truth,
                                             double clearance_m, double until_s);

}  // namespace ensonify
