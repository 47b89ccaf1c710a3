#include "ensonify/generators/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/generators/drift.hpp"
#include "ensonify/generators/read_trajectory.hpp"
#include "ensonify/generators/recipe_window.hpp"

namespace ensonify {
namespace {

constexpr int max_frames = 100'000'000;
constexpr Limits angle_limits{-360.0, 360.0};

/// A file beside the recipe where there is one, else the word as it is: a path or a bundled name of that kind.
std::string named(const Reader& reader, std::string_view key, const std::string& kind, const std::string& word) {
  std::error_code no_throw;
  const std::filesystem::path path = reader.folder() / word;
  if (std::filesystem::is_regular_file(path, no_throw)) return path.string();
  try {
    resolve_name(kind, word);
  } catch (const ConfigError& e) {
    reader.fail(key, e.what());
  }
  return word;
}

/// A mesh has no water, no bounds and no navigable box.
void refuse_mesh(const Reader& entry, const std::string& scene) {
  const std::string extension = std::filesystem::path(scene).extension().string();
  if (extension.empty() || extension == ".yaml" || extension == ".yml") return;
  entry.fail("scene", fmt::format("{} is no scene YAML; write one whose objects name the mesh, such as "
                                  "{{name: thing, mesh: {}, material: steel}}",
                                  scene, std::filesystem::path(scene).filename().string()));
}

/// The stem of a scene's file, which names files of the dataset.
std::string place_name(const Reader& entry, const std::string& scene) {
  constexpr std::size_t longest = 100;
  const std::string stem = std::filesystem::path(scene).stem().string();
  const bool harmless = std::none_of(stem.begin(), stem.end(), [](unsigned char c) {
    return c <= ' ' || c == 127 ||
           std::string_view("\\\"'*?:<>|/").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (stem.empty() || stem.size() > longest || stem[0] == '.' || stem[0] == '-' || !harmless) {
    entry.fail("scene", fmt::format("the file name, without extension, names files of the dataset: it must be 1 to {} "
                                    "bytes without blanks, control characters or any of \\ \" ' * ? : < > |, and not "
                                    "begin with . or -",
                                    longest));
  }
  return stem;
}

std::vector<PlaceRef> read_places(Reader& split) {
  std::vector<PlaceRef> places;
  for (Reader& entry : split.children("places")) {
    const std::string scene = named(entry, "scene", "scenes", entry.text("scene"));
    refuse_mesh(entry, scene);
    const std::string stem = place_name(entry, scene);
    const std::vector<double> layouts =
        entry.has("layouts") ? entry.numbers("layouts", -1, {0.0, 1e9}) : std::vector<double>{0.0};
    if (layouts.empty()) entry.fail("layouts", "needs at least one layout number");
    for (const double layout : layouts) {
      if (layout != static_cast<double>(static_cast<std::uint64_t>(layout))) {
        entry.fail("layouts", "must be a list of whole numbers");
      }
      const auto number = static_cast<std::uint64_t>(layout);
      const bool alone = layouts.size() == 1;
      places.push_back({alone ? stem : fmt::format("{}_layout{}", stem, number), scene, number});
    }
    entry.finish();
  }
  if (places.empty()) split.fail("places", "needs at least one scene");
  return places;
}

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
    for (const std::string& word : file.texts("noise")) profiles.push_back(named(file, "noise", "noise", word));
  } else {
    profiles.push_back(named(file, "noise", "noise", file.text("noise")));
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

/// A scene that splits use with one layout each would give its places one name.
void tell_apart(std::vector<Split>& all) {
  std::map<std::string, int> count;
  for (const Split& split : all) {
    for (const PlaceRef& place : split.places) ++count[place.name];
  }
  for (Split& split : all) {
    for (PlaceRef& place : split.places) {
      if (count[place.name] > 1) place.name = fmt::format("{}_layout{}", place.name, place.layout);
    }
  }
}

void refuse_shared_places(const Reader& splits, const std::vector<Split>& all) {
  std::set<std::pair<std::string, std::uint64_t>> seen;
  std::map<std::string, std::string> scene_of_name;
  for (const Split& split : all) {
    for (const PlaceRef& place : split.places) {
      if (!seen.emplace(place.scene, place.layout).second) {
        splits.fail(split.name, fmt::format("place {} layout {} is used twice; splits must not share a layout",
                                            place.scene, place.layout));
      }
      const auto [other, fresh] = scene_of_name.emplace(place.name, place.scene);
      if (!fresh) {
        splits.fail(split.name, fmt::format("{} and {} would both be the place {}, which names files of the dataset; "
                                            "rename one of the two",
                                            other->second, place.scene, place.name));
      }
    }
  }
}

}  // namespace

int Recipe::frames() const {
  return std::accumulate(splits.begin(), splits.end(), 0, [](int sum, const Split& s) { return sum + s.frames; });
}

Recipe load_recipe(const ConfigSource& source) {
  Reader file = open_config("generators", source);
  Recipe recipe;
  recipe.name = file.text("name");
  recipe.title = file.text_or("title", recipe.name);
  recipe.seed = static_cast<std::uint64_t>(file.number_or("seed", 0, {0.0, 9e15}));
  Reader sonar = file.child("sonar");
  recipe.sonar = named(sonar, "model", "sensor_models", sonar.text("model"));
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
    recipe.drift.radial_error_m = drift.number("radial_error_m", {0.0, 1e4});
    recipe.drift.after_s = drift.number("after_s", {1.0, 1e5});
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
