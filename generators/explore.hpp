#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "ensonify/generators/explore_world.hpp"

namespace ensonify {

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

/// Closes the loop: ping -> filter -> map -> next pose, from the map alone -> ping. Pings are simulated at true poses;
/// mapper, planner and guest get dead-reckoned ones, and a wanted pose is reached as dead reckoning believes it. The
/// same settings give the same steps on any number of threads. Throws ConfigError for settings that do not fit, and
/// what the guest throws.
ExploreRun explore(const Simulator& simulator, const ExploreSite& site, const Vehicle& vehicle,
                   const ExploreSettings& settings, const ExploreHooks& hooks);

}  // namespace ensonify
