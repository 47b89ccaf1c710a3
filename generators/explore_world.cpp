#include "ensonify/generators/explore_world.hpp"

#include <cmath>
#include <utility>

#include "ensonify/core/error.hpp"
#include "ensonify/core/grey_image.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/stop_watch.hpp"
#include "ensonify/mapping/integrate_ping.hpp"

namespace ensonify {

ExploreSettings explore_settings(const ExploreChoice& choice) {
  ExploreSettings settings;
  settings.filter = find_filter_or_none(choice.filter);
  settings.model = inverse_model_named(choice.model);
  const LogOddsStep step{milli_log_odds(choice.p_free), milli_log_odds(choice.p_occupied)};
  std::visit([&](auto& model) { model.step = step; }, settings.model);
  require_valid(settings.model);
  settings.threshold = choice.threshold;
  settings.steps = choice.steps;
  return settings;
}

ExploreWorld::ExploreWorld(const Simulator& simulator, const ExploreSite& site, const Vehicle& vehicle,
                           const ExploreSettings& settings)
    : simulator_(&simulator),
      site_(&site),
      vehicle_(&vehicle),
      settings_(&settings),
      grid_(site.map_frame, settings.limits),
      map_(slice_of(grid_)) {
  if (std::holds_alternative<Oracle>(settings.model)) {
    throw ConfigError("the model oracle needs true elevations, which a vehicle does not have; choose another model");
  }
  at_.truly = before_ = site.planar_start();
  const Eigen::Vector2d drift = drift_now_m();
  at_.believed = {at_.truly.x_m + drift.x(), at_.truly.y_m + drift.y(), at_.truly.yaw_rad};
}

Eigen::Vector2d ExploreWorld::drift_now_m() const {
  if (!settings_->drift) return Eigen::Vector2d::Zero();
  return drift_m(*settings_->drift, RandomKey::from_seed(settings_->seed).child("drift"), time_s());
}

ExploreTimes ExploreWorld::look() {
  ExploreTimes times;
  StopWatch watch;
  truly_ = site_->pose_at(at_.truly);
  believed_ = site_->pose_at(at_.believed);
  clearance_m_ = clearance_m(site_->truth, before_, at_.truly, clearance_far_m);
  path_m_ += std::hypot(at_.truly.x_m - before_.x_m, at_.truly.y_m - before_.y_m);
  before_ = at_.truly;

  const RandomKey seed = RandomKey::from_seed(settings_->seed);
  const PingKeys keys{seed, seed.child("noise").child(static_cast<std::uint64_t>(step_))};
  ping_.raw = std::move(simulator_->ping({truly_, {}, keys, false}).images.raw.grey);
  times.simulate_s = watch.lap_s();
  GreyImage filtered = apply(settings_->filter, to_grey(ping_.raw));
  times.filter_s = watch.lap_s();
  PosedImage posed{std::move(filtered.grey), simulator_->sonar().geometry, believed_, {}};
  integrate_ping(posed, settings_->threshold, settings_->model, grid_, scratch_);
  ping_.filtered = std::get<Image2<float>>(std::move(posed.grey));
  map_ = slice_of(grid_);
  times.map_s = watch.lap_s();
  return times;
}

ExploreStep ExploreWorld::scored(const Slice& map) const {
  return {step_, time_s(), truly_, believed_, score_slice(map, site_->reachable), clearance_m_, path_m_};
}

void ExploreWorld::move(const PlanarPose& wanted) {
  ++step_;
  const Eigen::Vector2d drift = drift_now_m();
  at_.truly = {at_.truly.x_m + wanted.x_m - at_.believed.x_m, at_.truly.y_m + wanted.y_m - at_.believed.y_m,
               wanted.yaw_rad};
  at_.believed = {at_.truly.x_m + drift.x(), at_.truly.y_m + drift.y(), wanted.yaw_rad};
}

}  // namespace ensonify
