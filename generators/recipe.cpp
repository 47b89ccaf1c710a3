#include "ensonify/generators/recipe.hpp"

#include <fmt/format.h>

#include <numeric>
#include <optional>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/describe.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/read_trajectory.hpp"
#include "ensonify/generators/recipe_places.hpp"
#include "ensonify/generators/recipe_window.hpp"

namespace ensonify {
namespace {

constexpr int max_frames = 100'000'000;
constexpr Limits angle_limits{-360.0, 360.0};

RandomPoses read_random_poses(Reader poses) {
  RandomPoses random;
  random.roll_deg = read_distribution_or(poses, "roll_deg", 0.0, angle_limits);
  random.pitch_deg = read_distribution_or(poses, "pitch_deg", 0.0, {-89.0, 89.0});
  if (poses.has("yaw_deg")) random.yaw_deg = read_distribution(poses, "yaw_deg", angle_limits);
  random.clearance_m = poses.number_or("clearance_m", random.clearance_m, {0.0, 10.0});
  random.least_seen_share = poses.number_or("least_seen_share", random.least_seen_share, {0.0, 1.0});
  random.tries = poses.integer_or("tries", random.tries, 1, 100000);
  poses.finish();
  return random;
}

std::vector<std::string> read_noise(Reader& file) {
  std::vector<std::string> profiles;
  if (file.has("noise") && file.node("noise").IsSequence()) {
    for (const std::string& word : file.texts("noise"))
      profiles.push_back(resolve_beside(file, "noise", "noise", word));
  } else {
    profiles.push_back(resolve_beside(file, "noise", "noise", file.text("noise")));
  }
  if (profiles.empty()) file.fail("noise", "needs at least one profile; none is a profile too");
  return profiles;
}

/// Why a split can not have its number of frames, and the key whose rule that is.
struct FramesFault {
  const char* key;
  std::string rule;
};

std::optional<FramesFault> frames_fault(const Split& split) {
  const auto* trajectory = std::get_if<TrajectoryPoses>(&split.poses);
  if (trajectory == nullptr) return std::nullopt;
  const int places = static_cast<int>(split.places.size());
  if (const int over = split.frames % places; over != 0) {
    const int less = split.frames - over;
    return FramesFault{"frames", fmt::format("must be a multiple of the {} places of a trajectory split, such as {}",
                                             places, less > 0 && 2 * over < places ? less : less + places)};
  }
  if (split.frames / places / trajectory->rate_hz > longest_drift_s) {
    return FramesFault{"trajectory", fmt::format("takes longer than the {:.0f} s that the drift is modelled for; ask "
                                                 "for fewer frames or a higher rate_hz",
                                                 longest_drift_s)};
  }
  return std::nullopt;
}

Split read_split(const std::string& name, Reader split) {
  Split result;
  result.name = name;
  result.places = read_places(split);
  if (split.has("frames_per_place") && split.has("frames")) {
    split.fail("frames", "does not go with 'frames_per_place'; keep one of the two");
  }
  if (split.has("trajectory") && split.has("random_poses")) {
    split.fail("random_poses", "does not go with 'trajectory'; keep one of the two");
  }
  if (split.has("frames_per_place")) {
    const int places = static_cast<int>(result.places.size());
    result.frames = split.integer("frames_per_place", 1, max_frames / places) * places;
  } else {
    result.frames = split.integer("frames", 1, max_frames);
  }
  if (split.has("trajectory")) {
    result.poses = read_trajectory(split.child("trajectory"));
  } else {
    result.poses = read_random_poses(split.child("random_poses"));
  }
  if (const auto fault = frames_fault(result)) split.fail(fault->key, fault->rule);
  split.finish();
  return result;
}

/// A set's manifest holds its recipe, whose paths start from the working folder that the set was made from.
Reader open_recipe(const ConfigSource& source) {
  Reader file = open_config("generators", source);
  if (!file.has("schema")) return file;
  file.choice("schema", {dataset_schema});
  return file.in_working_folder().child("recipe");
}

}  // namespace

int Recipe::frames() const {
  return std::accumulate(splits.begin(), splits.end(), 0, [](int sum, const Split& s) { return sum + s.frames; });
}

Recipe load_recipe(const ConfigSource& source) {
  Reader file = open_recipe(source);
  Recipe recipe;
  recipe.name = file.text("name");
  recipe.title = file.text_or("title", recipe.name);
  recipe.seed = static_cast<std::uint64_t>(file.number_or("seed", 0, {0.0, 9e15}));
  Reader sonar = file.child("sonar");
  recipe.sonar = resolve_beside(sonar, "model", "sensor_models", sonar.text("model"));
  if (sonar.has("range_min_m")) recipe.range_min_m = sonar.number("range_min_m", positive);
  if (sonar.has("range_max_m")) recipe.range_max_m = read_distribution(sonar, "range_max_m", positive);
  if (sonar.has("range_bins")) {
    recipe.range_bins = sonar.text("range_bins") == "native" ? 0 : sonar.integer("range_bins", 1, 16384);
  }
  recipe.gain_db = read_distribution_or(sonar, "gain_db", 0.0, {-60.0, 60.0});
  sonar.finish();
  check_window(sonar, recipe);
  recipe.noise = read_noise(file);
  if (file.has("mask")) {
    Reader mask = file.child("mask");
    recipe.mask_threshold = mask.integer("threshold", 1, 255);
    mask.finish();
  }
  recipe.cell_truth = file.boolean_or("truth", false);
  if (file.has("drift")) {
    Reader drift = file.child("drift");
    recipe.drift.radial_error_m = drift.number_or("radial_error_m", recipe.drift.radial_error_m, {0.0, 1e4});
    recipe.drift.after_s = drift.number_or("after_s", recipe.drift.after_s, {1.0, 1e5});
    drift.finish();
  }
  Reader splits = file.child("splits");
  for (const char* name : {"train", "val", "test"}) {
    if (splits.has(name)) recipe.splits.push_back(read_split(name, splits.child(name)));
  }
  splits.finish();
  if (recipe.splits.empty()) splits.fail("", "needs at least one of train, val, test");
  tell_apart(recipe.splits);
  refuse_shared_places(splits, recipe.splits);
  if (recipe.frames() > max_frames) splits.fail("", fmt::format("at most {} frames", max_frames));
  file.finish();
  return recipe;
}

void set_training_pairs(Recipe& recipe, int pairs) {
  const auto refuse = [&](const std::string& rule) { throw ConfigError(fmt::format("pairs {}: {}", pairs, rule)); };
  Split& train = recipe.splits.front();
  if (train.name != "train") refuse("the recipe has no split 'train'");
  const int others = recipe.frames() - train.frames;
  if (pairs < 1 || pairs > max_frames - others) {
    refuse(fmt::format("must lie in [1, {}]: a dataset has at most {} frames, the other splits {}", max_frames - others,
                       max_frames, others));
  }
  train.frames = pairs;
  if (const auto fault = frames_fault(train)) refuse(fmt::format("the split train: {}: {}", fault->key, fault->rule));
}

}  // namespace ensonify
