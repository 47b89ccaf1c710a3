#pragma once

#include <optional>
#include <string>
#include <utility>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/generators/explore_site.hpp"
#include "ensonify/generators/recipe.hpp"
#include "ensonify/generators/simulator.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

/// One ping and the way that led to it. The map's scores are those after the ping.
struct ExploreStep {
  int step = 0;
  double time_s = 0;  ///< of the simulated clock
  Pose T_world_sonar = Pose::Identity();
  Pose T_world_sonar_est = Pose::Identity();  ///< as mapper and planner believe it
  ExploreScores scores;
  double clearance_m = 0;  ///< least on the way here, true poses, at most `clearance_far_m`
  double path_m = 0;       ///< true way so far
};
inline constexpr double clearance_far_m = 2;

/// Seconds of the computer's clock that a step took: kept apart, since they are no result.
struct ExploreTimes {
  double simulate_s = 0, filter_s = 0, map_s = 0, guest_s = 0, plan_s = 0;
};

struct ExplorePing {
  Image2<std::uint8_t> raw;
  Image2<float> filtered;  ///< 0..255
};

/// What there is to see and to show after a ping was mapped.
struct ExploreMoment {
  int step = 0;
  const Pose& T_world_sonar;
  const Pose& T_world_sonar_est;
  const ExplorePing& ping;
  const LogOddsGrid& grid;
  double clearance_m = 0, path_m = 0;  ///< as in ExploreStep
};

/// What commands and Python take unless told otherwise.
struct ExploreChoice {
  std::string sonar = "oculus_m1200d_lf", noise = "paper", filter = "median", model = "arc_shadow";
  double range_max_m = 10;
  double threshold = 60;  ///< grey levels
  double p_free = 0.4, p_occupied = 0.7;
  int steps = 1000;
};

/// How pings are believed.
struct ExploreSettings {
  std::uint64_t seed = 0;
  FilterChain filter;
  InverseModel model;
  LogOddsLimits limits{-4000, 4000};  ///< of the map's cells: what was wrong for long can be right soon
  double threshold = 0;               ///< grey levels
  int steps = 0;
  std::optional<Drift> drift;
};

/// Filter, model and threshold as chosen. Throws ConfigError.
ExploreSettings explore_settings(const ExploreChoice& choice);

/// The vehicle in its place: sonar, dead reckoning, filter, map and clock. look() and move() take turns. Pings are
/// simulated at true poses; the map gets dead-reckoned ones.
class ExploreWorld {
 public:
  /// All arguments must outlive it. Throws ConfigError for settings that do not fit.
  ExploreWorld(const Simulator& simulator, const ExploreSite& site, const Vehicle& vehicle,
               const ExploreSettings& settings);

  /// Pings from where the vehicle is, filters, and maps. Tells the time of each.
  ExploreTimes look();
  /// A move within the limits of motion, to where the vehicle will believe to be if it drifts no more.
  void move(const PlanarPose& wanted);

  /// Of the last look.
  ExploreMoment moment() const { return {step_, truly_, believed_, ping_, grid_, clearance_m_, path_m_}; }
  const Slice& map() const { return map_; }
  /// The same, scored on `map`: ours, or a guest's.
  ExploreStep scored(const Slice& map) const;
  /// Where the vehicle believes to be.
  const PlanarPose& at() const { return at_.believed; }
  /// The map in full; the world is then over.
  LogOddsGrid take_grid() && { return std::move(grid_); }

 private:
  struct Position {
    PlanarPose truly, believed;
  };
  Eigen::Vector2d drift_now_m() const;
  double time_s() const { return step_ / vehicle_->limits.ping_rate_hz; }

  const Simulator* simulator_;
  const ExploreSite* site_;
  const Vehicle* vehicle_;
  const ExploreSettings* settings_;
  int step_ = 0;
  Position at_;
  PlanarPose before_;  ///< true, of the last look
  double clearance_m_ = 0, path_m_ = 0;
  Pose truly_ = Pose::Identity(), believed_ = Pose::Identity();
  ExplorePing ping_;
  LogOddsGrid grid_;
  Slice map_;
  MarkBox<Mark> scratch_;
};

}  // namespace ensonify
