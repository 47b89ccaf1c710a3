#include "ensonify/generators/explore.hpp"

#include "ensonify/generators/explore_planner.hpp"
#include "ensonify/generators/stop_watch.hpp"

namespace ensonify {
namespace {

PlannerSettings planner_for(const ExploreSite& site, const Vehicle& vehicle) {
  PlannerSettings planner;
  planner.view = site.view;
  planner.limits = vehicle.limits;
  planner.radius_m = vehicle.radius_m;
  planner.clearance_m = vehicle.radius_m + vehicle.margin_m;
  planner.area = site.area;
  planner.interest = site.interest;
  return planner;
}

}  // namespace

const char* name_of(ExploreEnd end) {
  switch (end) {
    case ExploreEnd::all_steps:
      return "all_steps";
    case ExploreEnd::explored:
      return "explored";
    case ExploreEnd::guest_done:
      return "plugin_done";
    case ExploreEnd::aground:
      return "aground";
    case ExploreEnd::stopped:
      return "stopped";
  }
  return "";
}

ExploreRun explore(const Simulator& simulator, const ExploreSite& site, const Vehicle& vehicle,
                   const ExploreSettings& settings, const ExploreHooks& hooks) {
  ExploreWorld world(simulator, site, vehicle, settings);
  const PlannerSettings planner = planner_for(site, vehicle);
  PlannerMemory memory = memory_at(world.map(), site.planar_start(), site.known_free_m);
  ExploreRun run{ExploreEnd::all_steps, {}, {}, world.map(), {}, LogOddsGrid(site.map_frame, settings.limits)};

  for (int step = 0; step < settings.steps; ++step) {
    ExploreTimes times = world.look();
    StopWatch watch;
    GuestReply guest;
    if (hooks.guest) guest = hooks.guest(world.moment());
    run.map = guest.map ? std::move(*guest.map) : world.map();
    times.guest_s = watch.lap_s();

    run.steps.push_back(world.scored(run.map));
    watch.lap_s();
    std::optional<PlanarPose> next;
    if (guest.wanted) {
      next = limited_step(world.at(), *guest.wanted, vehicle.limits);
    } else if (!guest.done) {
      next = plan_step(planner, run.map, world.at(), memory);
    }
    times.plan_s = watch.lap_s();
    run.times.push_back(times);

    const bool go_on = !hooks.after_step || hooks.after_step(world.moment(), run.map, run.steps);
    if (run.steps.back().clearance_m <= 0)
      run.end = ExploreEnd::aground;
    else if (guest.done)
      run.end = ExploreEnd::guest_done;
    else if (!next)
      run.end = ExploreEnd::explored;
    else if (!go_on)
      run.end = ExploreEnd::stopped;
    if (run.end != ExploreEnd::all_steps) break;
    world.move(*next);
  }
  run.ping = world.moment().ping;
  run.grid = std::move(world).take_grid();
  return run;
}

}  // namespace ensonify
