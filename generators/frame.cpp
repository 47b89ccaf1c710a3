#include "ensonify/generators/frame.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/random_pose.hpp"
#include "ensonify/generators/waypoint_path.hpp"

namespace ensonify {
namespace {

std::vector<PlaceRef> all_places(const Recipe& recipe) {
  std::vector<PlaceRef> places;
  for (const Split& split : recipe.splits) places.insert(places.end(), split.places.begin(), split.places.end());
  return places;
}

RangeWindow window_of(const Recipe& recipe, std::optional<double> range_max_m) {
  return {recipe.range_min_m, range_max_m, recipe.range_bins};
}

std::optional<double> fixed_range_max(const Recipe& recipe) {
  if (!recipe.range_max_m || !std::holds_alternative<Constant>(*recipe.range_max_m)) return std::nullopt;
  return std::get<Constant>(*recipe.range_max_m).value;
}

bool window_varies(const Recipe& recipe) {
  return recipe.range_max_m && !std::holds_alternative<Constant>(*recipe.range_max_m);
}

}  // namespace

struct FrameMaker::Slot {
  std::once_flag built;
  std::optional<Place> place;
  std::optional<PingTracer> tracer;
  std::optional<WaypointPath> path;
};

FrameMaker::FrameMaker(Recipe recipe, std::string isa)
    : recipe_(std::move(recipe)),
      isa_(std::move(isa)),
      sonar_(load_sonar(recipe_.sonar, window_of(recipe_, fixed_range_max(recipe_)))),
      spread_(sonar_),
      noise_(load_noise(recipe_.noise)),
      places_(all_places(recipe_)),
      slots_(std::make_unique<Slot[]>(places_.size())) {}

FrameMaker::~FrameMaker() = default;

const FrameMaker::Slot& FrameMaker::slot(int index) const {
  Slot& slot = slots_[static_cast<std::size_t>(index)];
  std::call_once(slot.built, [&] {
    // Isolated: a thread that waits inside must not pick up another frame, which might wait for this very place.
    tbb::this_task_arena::isolate([&] {
      const PlaceRef& ref = places_[static_cast<std::size_t>(index)];
      slot.place.emplace(make_place(ref.scene, ref.layout, isa_));
      slot.tracer.emplace(slot.place->rays, sonar_, slot.place->scene.water);
      if (!slot.place->scene.waypoints.empty()) slot.path.emplace(slot.place->scene.waypoints);
    });
  });
  return slot;
}

const Place& FrameMaker::place(int index) const { return *slot(index).place; }

RandomKey FrameMaker::frame_key(int index) const {
  return RandomKey::from_seed(recipe_.seed).child("frame").child(static_cast<std::uint64_t>(index));
}

FramePose FrameMaker::locate(int index) const {
  FramePose frame;
  frame.index = index;
  frame.number = index;
  int first_place = 0;
  while (frame.number >= recipe_.splits[frame.split].frames) {
    frame.number -= recipe_.splits[frame.split].frames;
    first_place += static_cast<int>(recipe_.splits[frame.split].places.size());
    ++frame.split;
  }
  const Split& split = recipe_.splits[frame.split];
  const int places = static_cast<int>(split.places.size());
  const bool random = std::holds_alternative<RandomPoses>(split.poses);
  frame.place = first_place + (random ? frame.number % places : frame.number / (split.frames / places));
  return frame;
}

FramePose FrameMaker::pose(int index) const {
  FramePose frame = locate(index);
  const Split& split = recipe_.splits[frame.split];
  if (const auto* random = std::get_if<RandomPoses>(&split.poses)) {
    const Place& where = place(frame.place);
    const auto sampled = sample_pose(*random, where, sonar_.geometry, frame_key(index).child("pose"));
    if (!sampled) {
      throw DataError(fmt::format(
          "frame {}: no pose in {} has {} m of room and sees enough after {} tries; widen the navigable box, or lower "
          "clearance_m or least_seen_share in the recipe",
          index, places_[frame.place].name, random->clearance_m, random->tries));
    }
    frame.T_world_sonar = frame.T_world_sonar_est = sampled->T_world_sonar;
    frame.sampled.emplace_back("pose.tries", sampled->tries);
    return frame;
  }

  const auto& trajectory = std::get<TrajectoryPoses>(split.poses);
  const int frames_each = split.frames / static_cast<int>(split.places.size());
  const Slot& where = slot(frame.place);
  const std::string& name = places_[frame.place].name;
  if (!where.path) throw ConfigError(fmt::format("scene {}: has no waypoints, which a trajectory split needs", name));
  const double time_s = (frame.number % frames_each) / trajectory.rate_hz;
  frame.time_s = time_s;
  frame.T_world_sonar = where.path->at(trajectory.speed_mps * time_s);
  const Vec3 p = frame.T_world_sonar.translation();
  if (!has_room(where.place->truth, p, 0.0)) {
    throw ConfigError(fmt::format(
        "scene {}: the trajectory runs into something at ({:.2f}, {:.2f}, {:.2f}) m, {} s after its start (frame {}); "
        "move its waypoints",
        name, p.x(), p.y(), p.z(), time_s, index));
  }
  const RandomKey drift_key = RandomKey::from_seed(recipe_.seed).child("drift").child(name);
  frame.T_world_sonar_est = drifted(frame.T_world_sonar, recipe_.drift, drift_key, time_s);
  return frame;
}

SonarModel FrameMaker::sonar_for(int index) const {
  SampledValues unused;
  return sonar_for(index, unused);
}

SonarModel FrameMaker::sonar_for(int index, SampledValues& sampled) const {
  if (!window_varies(recipe_)) return sonar_;
  RandomSequence random(frame_key(index).child("range_max_m"));
  const double range_max_m = sample(*recipe_.range_max_m, random);
  sampled.emplace_back("sonar.range_max_m", range_max_m);
  return load_sonar(recipe_.sonar, window_of(recipe_, range_max_m));
}

Ping FrameMaker::ping(const FramePose& pose, bool cell_truth) const {
  const Slot& where = slot(pose.place);
  if (!window_varies(recipe_)) return where.tracer->trace(pose.T_world_sonar, cell_truth);
  return PingTracer(where.place->rays, sonar_for(pose.index), where.place->scene.water)
      .trace(pose.T_world_sonar, cell_truth);
}

Frame FrameMaker::make(int index) const {
  const RandomKey key = frame_key(index);
  Frame frame;
  frame.pose = pose(index);
  SampledValues& sampled = frame.pose.sampled;
  frame.sonar = sonar_for(index, sampled);
  Ping ping = this->ping(frame.pose, recipe_.cell_truth);

  ImageSettings settings;
  settings.noise = sample_noise(noise_, key.child("noise parameters"), sampled);
  RandomSequence random(key.child("gain_db"));
  settings.gain_db = sample(recipe_.gain_db, random);
  if (!std::holds_alternative<Constant>(recipe_.gain_db)) sampled.emplace_back("sonar.gain_db", settings.gain_db);
  settings.mask_threshold = recipe_.mask_threshold;

  frame.images =
      window_varies(recipe_)
          ? form_images(frame.sonar, PointSpread(frame.sonar), ping.echo, ping.truth, settings, key.child("noise"))
          : form_images(frame.sonar, spread_, ping.echo, ping.truth, settings, key.child("noise"));
  frame.truth = std::move(ping.truth);
  frame.echo = std::move(ping.echo);
  return frame;
}

}  // namespace ensonify
