#include "ensonify/generators/frame.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/random_pose.hpp"

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

/// Times in a TUM file have some digits: the last frame may lie this far behind its last pose.
constexpr double stamp_rounding_s = 1e-6;

const char* cure_of(const PathSpec& path) {
  struct {
    const char* operator()(const SceneWaypoints&) const { return "move its waypoints"; }
    const char* operator()(const OwnWaypoints&) const { return "move its waypoints"; }
    const char* operator()(const Lawnmower&) const { return "change depth_m or area"; }
    const char* operator()(const Orbit&) const { return "change radius_m, depth_m or turns"; }
    const char* operator()(const WallFollow&) const { return "change standoff_m, depth_m or side"; }
    const char* operator()(const RecordedPath&) const { return "give a file that keeps clear"; }
  } visitor;
  return std::visit(visitor, path);
}

bool window_varies(const Recipe& recipe) {
  return recipe.range_max_m && !std::holds_alternative<Constant>(*recipe.range_max_m);
}

}  // namespace

struct FrameMaker::Slot {
  std::once_flag built;
  std::optional<Place> place;
  std::optional<PingTracer> tracer;
  std::optional<Trajectory> trajectory;

  void free_ray_caster() {
    tracer.reset();
    const RayScene freed = std::move(place->rays);
  }
};

FrameMaker::FrameMaker(Recipe recipe, std::string isa)
    : recipe_(std::move(recipe)),
      isa_(std::move(isa)),
      receiver_(load_sonar(recipe_.sonar, window_of(recipe_, fixed_range_max(recipe_)))),
      places_(all_places(recipe_)),
      slots_(std::make_unique<Slot[]>(places_.size())) {
  for (const std::string& noise : recipe_.noise) {
    noises_.push_back(load_noise(noise));
    check_noise(noises_.back(), receiver_.sonar);
  }
}

FrameMaker::~FrameMaker() = default;

const FrameMaker::Slot& FrameMaker::slot(int index) const {
  Slot& slot = slots_[static_cast<std::size_t>(index)];
  std::call_once(slot.built, [&] {
    // Isolated: a thread that waits inside must not pick up another frame, which might wait for this very place.
    tbb::this_task_arena::isolate([&] {
      const PlaceRef& ref = places_[static_cast<std::size_t>(index)];
      slot.place.emplace(make_place(ref.scene, ref.layout, isa_));
      slot.tracer.emplace(slot.place->rays, receiver_.sonar, slot.place->scene.water);
      if (const auto* spec = std::get_if<TrajectoryPoses>(&split_of_place(index).poses)) {
        const RandomKey key = RandomKey::from_seed(recipe_.seed).child("trajectory").child(ref.name);
        slot.trajectory.emplace(*spec, slot.place->scene, key);
      }
      slot.place->scene.meshes = {};  // the ray caster has its own copy, and sets have many places
      if (pings_ended_) slot.free_ray_caster();
    });
  });
  return slot;
}

void FrameMaker::end_pings() {
  pings_ended_ = true;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (slots_[i].place) slots_[i].free_ray_caster();
  }
}

const Place& FrameMaker::place(int index) const { return *slot(index).place; }

RandomKey FrameMaker::frame_key(int index) const {
  return RandomKey::from_seed(recipe_.seed).child("frame").child(static_cast<std::uint64_t>(index));
}

/// Instruments keep their settings along a trajectory; frames of random poses draw their own.
RandomKey FrameMaker::settings_key(const FramePose& frame) const {
  if (std::holds_alternative<RandomPoses>(recipe_.splits[static_cast<std::size_t>(frame.split)].poses)) {
    return frame_key(frame.index);
  }
  return RandomKey::from_seed(recipe_.seed)
      .child("settings")
      .child(places_[static_cast<std::size_t>(frame.place)].name);
}

int FrameMaker::first_place_of(int split) const {
  int first = 0;
  for (int s = 0; s < split; ++s) first += static_cast<int>(recipe_.splits[s].places.size());
  return first;
}

FramePose FrameMaker::locate(int index) const {
  FramePose frame;
  frame.index = index;
  frame.number = index;
  while (frame.number >= recipe_.splits[frame.split].frames) {
    frame.number -= recipe_.splits[frame.split].frames;
    ++frame.split;
  }
  const int first_place = first_place_of(frame.split);
  const Split& split = recipe_.splits[frame.split];
  const int places = static_cast<int>(split.places.size());
  const bool random = std::holds_alternative<RandomPoses>(split.poses);
  frame.place = first_place + (random ? frame.number % places : frame.number / (split.frames / places));
  RandomSequence draw(settings_key(frame).child("noise profile"));
  frame.noise = draw.below(static_cast<int>(noises_.size()));
  return frame;
}

const Split& FrameMaker::split_of_place(int place) const {
  std::size_t split = 0;
  for (int left = place; left >= static_cast<int>(recipe_.splits[split].places.size()); ++split) {
    left -= static_cast<int>(recipe_.splits[split].places.size());
  }
  return recipe_.splits[split];
}

const Trajectory* FrameMaker::trajectory(int place) const {
  const Slot& where = slot(place);
  return where.trajectory ? &*where.trajectory : nullptr;
}

double FrameMaker::swum_until_s(int place) const {
  const Split& split = split_of_place(place);
  const int frames_each = split.frames / static_cast<int>(split.places.size());
  return (frames_each - 1) / std::get<TrajectoryPoses>(split.poses).rate_hz;
}

void FrameMaker::check_trajectory(int place) const {
  const Trajectory* swum = trajectory(place);
  if (!swum) return;
  if (swum_until_s(place) > swum->lasts_s() + stamp_rounding_s) refuse_short(place);
  const auto& spec = std::get<TrajectoryPoses>(split_of_place(place).poses);
  const auto obstruction = first_obstruction(*swum, this->place(place).truth, spec.clearance_m, swum_until_s(place));
  if (obstruction) refuse_obstructed(place, *obstruction);
}

void FrameMaker::refuse_short(int place) const {
  const Split& split = split_of_place(place);
  const auto& spec = std::get<TrajectoryPoses>(split.poses);
  const double lasts_s = trajectory(place)->lasts_s();
  const int covered = 1 + static_cast<int>((lasts_s + stamp_rounding_s) * spec.rate_hz);
  throw ConfigError(
      fmt::format("{}: the file lasts {:.3f} s, which covers {} frames at {} Hz; the split asks for {} in each place: "
                  "ask for fewer, "
                  "raise rate_hz, or give a longer file",
                  spec.where, lasts_s, covered, spec.rate_hz, split.frames / static_cast<int>(split.places.size())));
}

void FrameMaker::refuse_obstructed(int place, const Obstruction& at) const {
  const auto& spec = std::get<TrajectoryPoses>(split_of_place(place).poses);
  const GridFrame& grid = slot(place).place->truth.frame;
  const auto cell = grid.cell_of(at.p_world);
  const bool outside = !grid.contains(cell[0], cell[1], cell[2]);
  const std::string what = outside                  ? "leaves the bounds of the scene"
                           : spec.clearance_m > 0.0 ? fmt::format("comes within {} m of something", spec.clearance_m)
                                                    : "runs into something";
  throw ConfigError(
      fmt::format("scene {}: the trajectory {} at ({:.2f}, {:.2f}, {:.2f}) m, {:.3g} s after its start "
                  "({}); {}",
                  places_[static_cast<std::size_t>(place)].name, what, at.p_world.x(), at.p_world.y(), at.p_world.z(),
                  at.time_s, spec.where, cure_of(spec.path)));
}

FramePose FrameMaker::random_pose(FramePose frame, RandomKey key) const {
  const auto& random = std::get<RandomPoses>(recipe_.splits[frame.split].poses);
  const auto sampled = sample_pose(random, place(frame.place), receiver_.sonar.geometry, key);
  if (!sampled) {
    const std::string which =
        frame.index < 0 ? std::string("a frame beyond the set") : fmt::format("frame {}", frame.index);
    throw DataError(fmt::format(
        "{}: no pose in {} has {} m of room and sees enough after {} tries; widen the navigable box, or lower "
        "clearance_m or least_seen_share in the recipe",
        which, places_[frame.place].name, random.clearance_m, random.tries));
  }
  frame.T_world_sonar = frame.T_world_sonar_est = sampled->T_world_sonar;
  frame.sampled.emplace_back("pose.tries", sampled->tries);
  return frame;
}

FramePose FrameMaker::pose(int index) const {
  FramePose frame = locate(index);
  const Split& split = recipe_.splits[frame.split];
  if (std::holds_alternative<RandomPoses>(split.poses)) return random_pose(frame, frame_key(index).child("pose"));

  const auto& spec = std::get<TrajectoryPoses>(split.poses);
  const Slot& where = slot(frame.place);
  const int frames_each = split.frames / static_cast<int>(split.places.size());
  const double time_s = (frame.number % frames_each) / spec.rate_hz;
  if (time_s > where.trajectory->lasts_s() + stamp_rounding_s) refuse_short(frame.place);
  frame.time_s = time_s;
  frame.T_world_sonar = where.trajectory->at(time_s);
  const Vec3 p = frame.T_world_sonar.translation();
  if (!has_room(where.place->truth, p, spec.clearance_m)) refuse_obstructed(frame.place, {time_s, p});
  if (!std::holds_alternative<Constant>(spec.speed_mps) && where.trajectory->speed_mps()) {
    frame.sampled.emplace_back("trajectory.speed_mps", *where.trajectory->speed_mps());
  }
  if (spec.motion_during_ping) frame.motion = twist_at(*where.trajectory, time_s);
  const std::string& name = places_[frame.place].name;
  const RandomKey drift_key = RandomKey::from_seed(recipe_.seed).child("drift").child(name);
  frame.T_world_sonar_est = drifted(frame.T_world_sonar, recipe_.drift, drift_key, time_s);
  return frame;
}

SonarModel FrameMaker::sonar_for(int index) const {
  SampledValues unused;
  return sonar_drawn(settings_key(locate(index)), unused);
}

SonarModel FrameMaker::sonar_drawn(RandomKey settings, SampledValues& sampled) const {
  if (!window_varies(recipe_)) return receiver_.sonar;
  RandomSequence random(settings.child("range_max_m"));
  const double range_max_m = sample(*recipe_.range_max_m, random);
  sampled.emplace_back("sonar.range_max_m", range_max_m);
  return load_sonar(recipe_.sonar, window_of(recipe_, range_max_m));
}

Ping FrameMaker::trace(const FramePose& pose, const SonarModel& sonar, const TraceOptions& options) const {
  const Slot& where = slot(pose.place);
  if (!window_varies(recipe_)) return where.tracer->trace(pose.T_world_sonar, options);
  return PingTracer(where.place->rays, sonar, where.place->scene.water).trace(pose.T_world_sonar, options);
}

Ping FrameMaker::ping(const FramePose& pose, const TraceOptions& options) const {
  return trace(pose, sonar_for(pose.index), options);
}

Frame FrameMaker::form(FramePose pose, const Keys& keys) const {
  Frame frame;
  frame.pose = std::move(pose);
  SampledValues& sampled = frame.pose.sampled;
  frame.sonar = sonar_drawn(keys.settings, sampled);

  ImageSettings settings;
  settings.noise = sample_noise(noises_[static_cast<std::size_t>(frame.pose.noise)],
                                keys.settings.child("noise parameters"), sampled);
  RandomSequence random(keys.settings.child("gain_db"));
  settings.gain_db = sample(recipe_.gain_db, random);
  if (!std::holds_alternative<Constant>(recipe_.gain_db)) sampled.emplace_back("sonar.gain_db", settings.gain_db);
  settings.mask_threshold = recipe_.mask_threshold;

  const PingSetting setting{frame.pose.T_world_sonar, keys.set.child("surface").child(places_[frame.pose.place].name),
                            keys.set.child("device").child(receiver_.sonar.name), keys.frame.child("noise"),
                            absorption_db_per_m(place(frame.pose.place).scene.water, frame.sonar.frequency_hz)};
  TraceOptions options = trace_options(settings.noise, recipe_.cell_truth);
  options.motion = frame.pose.motion;
  Ping ping = trace(frame.pose, frame.sonar, options);
  frame.images = window_varies(recipe_) ? form_images(Receiver(frame.sonar), ping, settings, setting)
                                        : form_images(receiver_, ping, settings, setting);
  frame.truth = std::move(ping.truth);
  frame.echo = std::move(ping.echo);
  return frame;
}

Frame FrameMaker::make(int index) const {
  FramePose where = pose(index);
  const Keys keys{RandomKey::from_seed(recipe_.seed), frame_key(index), settings_key(where)};
  return form(std::move(where), keys);
}

Frame FrameMaker::draw(int split, RandomKey seed, RandomKey frame) const {
  const Split& from = recipe_.splits.at(static_cast<std::size_t>(split));
  if (!std::holds_alternative<RandomPoses>(from.poses)) {
    throw ConfigError(fmt::format(
        "recipe {}: the poses of split {} lie on trajectories; frames without end need a split with random_poses",
        recipe_.name, from.name));
  }
  FramePose where;
  where.index = -1;
  where.split = split;
  where.place =
      first_place_of(split) + RandomSequence(frame.child("place")).below(static_cast<int>(from.places.size()));
  where.noise = RandomSequence(frame.child("noise profile")).below(static_cast<int>(noises_.size()));
  return form(random_pose(where, frame.child("pose")), {seed, frame, frame});
}

}  // namespace ensonify
