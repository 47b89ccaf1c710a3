#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/generators/explore_site.hpp"
#include "ensonify/generators/form_images.hpp"
#include "ensonify/generators/recipe.hpp"

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
};

/// A mapper or planner from outside. What it leaves empty, ours does.
struct GuestReply {
  std::optional<PlanarPose> wanted;  ///< where to go next, as the vehicle believes; limits of motion apply
  std::optional<Slice> map;          ///< its map, to be scored and planned on
  bool done = false;
};

struct ExploreHooks {
  std::function<GuestReply(const ExploreMoment&)> guest;  ///< may be empty
  /// After every step; `map` is what was scored. False ends the run.
  std::function<bool(const ExploreMoment&, const Slice& map, const std::vector<ExploreStep>& so_far)> after_step;
};

enum class ExploreEnd : std::uint8_t {
  all_steps,  ///< as many as asked for
  explored,   ///< nothing that can be reached is worth a look
  guest_done,
  aground,  ///< the sonar is inside of something
  stopped,  ///< by after_step
};
const char* name_of(ExploreEnd end);

struct ExploreRun {
  ExploreEnd end = ExploreEnd::all_steps;
  std::vector<ExploreStep> steps;
  std::vector<ExploreTimes> times;
  Slice map;         ///< that was scored last
  ExplorePing ping;  ///< the last
  LogOddsGrid grid;  ///< ours
};

/// How pings are made and believed.
struct ExploreSettings {
  std::string isa = default_isa;
  std::uint64_t seed = 0;
  SonarModel sonar;
  NoiseProfile noise;
  FilterChain filter;
  InverseModel model;
  LogOddsLimits limits{-4000, 4000};  ///< of the map's cells: what was wrong for long can be right soon
  double threshold = 0;               ///< grey levels
  int steps = 0;
  std::optional<Drift> drift;
};

/// Closes the loop: ping -> filter -> map -> next pose, from the map alone -> ping. Pings are simulated at true poses;
/// mapper, planner and guest get dead-reckoned ones, and a wanted pose is reached as dead reckoning believes it. The
/// same settings give the same steps on any number of threads. Throws ConfigError for settings that do not fit, and
/// what the guest throws.
ExploreRun explore(const Scene& scene, const ExploreSite& site, const Vehicle& vehicle, const ExploreSettings& settings,
                   const ExploreHooks& hooks);

}  // namespace ensonify
