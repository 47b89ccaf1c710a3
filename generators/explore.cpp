#include "ensonify/generators/explore.hpp"

#include <chrono>
#include <utility>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/mapping/integrate_ping.hpp"

namespace ensonify {
namespace {

/// A sonar in a place: images of pings.
class Station {
 public:
  Station(const Scene& scene, const ExploreSettings& settings)
      : key_(RandomKey::from_seed(settings.seed)),
        surface_(key_.child("surface").child(scene.name)),
        device_(key_.child("device").child(settings.sonar.name)),
        rays_(scene, settings.isa),
        receiver_(settings.sonar),
        tracer_(rays_, settings.sonar, scene.water) {
    check_noise(settings.noise, settings.sonar);
    SampledValues sampled;
    images_.noise = sample_noise(settings.noise, key_.child("noise parameters"), sampled);
    options_ = trace_options(images_.noise, false);
  }

  Image2<std::uint8_t> ping(const Pose& T_world_sonar, int step) const {
    const Ping echo = tracer_.trace(T_world_sonar, options_);
    const PingSetting setting{T_world_sonar, surface_, device_,
                              key_.child("noise").child(static_cast<std::uint64_t>(step))};
    return form_images(receiver_, echo, images_, setting).raw.grey;
  }

 private:
  RandomKey key_, surface_, device_;
  RayScene rays_;
  Receiver receiver_;
  PingTracer tracer_;
  ImageSettings images_;
  TraceOptions options_;
};

class StopWatch {
 public:
  /// Seconds since the last call.
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Where the vehicle is, and where it thinks it is.
struct Position {
  PlanarPose truly;
  PlanarPose believed;
};

Eigen::Vector2d error_m(const ExploreSettings& settings, double time_s) {
  if (!settings.drift) return Eigen::Vector2d::Zero();
  return drift_m(*settings.drift, RandomKey::from_seed(settings.seed).child("drift"), time_s);
}

Position at_start(const PlanarPose& start, const Eigen::Vector2d& error) {
  return {start, {start.x_m + error.x(), start.y_m + error.y(), start.yaw_rad}};
}

/// The vehicle makes the move that it wants; meanwhile the error of dead reckoning becomes `error`.
Position moved(const Position& from, const PlanarPose& wanted, const Eigen::Vector2d& error) {
  Position to;
  to.truly = {from.truly.x_m + wanted.x_m - from.believed.x_m, from.truly.y_m + wanted.y_m - from.believed.y_m,
              wanted.yaw_rad};
  to.believed = {to.truly.x_m + error.x(), to.truly.y_m + error.y(), wanted.yaw_rad};
  return to;
}

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

ExploreRun explore(const Scene& scene, const ExploreSite& site, const Vehicle& vehicle, const ExploreSettings& settings,
                   const ExploreHooks& hooks) {
  if (std::holds_alternative<Oracle>(settings.model)) {
    throw ConfigError("the model oracle needs true elevations, which a vehicle does not have; choose another --model");
  }
  const Station station(scene, settings);
  const PlannerSettings planner = planner_for(site, vehicle);
  ExploreRun run{ExploreEnd::all_steps, {}, {}, {}, {}, LogOddsGrid(site.map_frame, settings.limits)};
  run.map = slice_of(run.grid);
  PlannerMemory memory = memory_at(run.map, site.planar_start(), site.known_free_m);
  MarkBox<Mark> scratch;
  Position at = at_start(site.planar_start(), error_m(settings, 0));
  PlanarPose before = at.truly;
  double path_m = 0;

  for (int step = 0; step < settings.steps; ++step) {
    ExploreTimes times;
    StopWatch watch;
    const Pose truly = site.pose_at(at.truly);
    const Pose believed = site.pose_at(at.believed);
    const double clear_m = clearance_m(site.truth, before, at.truly, clearance_far_m);
    path_m += std::hypot(at.truly.x_m - before.x_m, at.truly.y_m - before.y_m);

    run.ping.raw = station.ping(truly, step);
    times.simulate_s = watch.lap_s();
    GreyImage filtered = apply(settings.filter, to_grey(run.ping.raw));
    times.filter_s = watch.lap_s();
    PosedImage posed{std::move(filtered.grey), settings.sonar.geometry, believed, {}};
    integrate_ping(posed, settings.threshold, settings.model, run.grid, scratch);
    run.ping.filtered = std::get<Image2<float>>(std::move(posed.grey));
    run.map = slice_of(run.grid);
    times.map_s = watch.lap_s();

    const ExploreMoment moment{step, truly, believed, run.ping, run.grid};
    GuestReply guest;
    if (hooks.guest) guest = hooks.guest(moment);
    if (guest.map) run.map = std::move(*guest.map);
    times.guest_s = watch.lap_s();

    const double time_s = step / vehicle.limits.ping_rate_hz;
    run.steps.push_back({step, time_s, truly, believed, score_slice(run.map, site.reachable), clear_m, path_m});
    watch.lap_s();
    std::optional<PlanarPose> next;
    if (guest.wanted) {
      next = limited_step(at.believed, *guest.wanted, vehicle.limits);
    } else if (!guest.done) {
      next = plan_step(planner, run.map, at.believed, memory);
    }
    times.plan_s = watch.lap_s();
    run.times.push_back(times);

    const bool go_on = !hooks.after_step || hooks.after_step(moment, run.map, run.steps);
    if (clear_m <= 0)
      run.end = ExploreEnd::aground;
    else if (guest.done)
      run.end = ExploreEnd::guest_done;
    else if (!next)
      run.end = ExploreEnd::explored;
    else if (!go_on)
      run.end = ExploreEnd::stopped;
    if (run.end != ExploreEnd::all_steps) break;
    before = at.truly;
    at = moved(at, *next, error_m(settings, (step + 1) / vehicle.limits.ping_rate_hz));
  }
  return run;
}

}  // namespace ensonify
