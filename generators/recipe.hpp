#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/config/distribution.hpp"
#include "ensonify/config/library.hpp"
#include "ensonify/generators/trajectory_spec.hpp"

namespace ensonify {

/// A scene in one of its layouts: the unit of splits.
struct PlaceRef {
  std::string name;   ///< of its files: as given, else the scene's; with _layout<N> where the recipe uses several
  std::string scene;  ///< path or bundled name
  std::uint64_t layout = 0;
};

/// Poses without order or time: position uniform over the navigable water, attitude drawn, kept where the vehicle has
/// room and the fan meets something.
struct RandomPoses {
  Distribution roll_deg = Constant{0};
  Distribution pitch_deg = Constant{0};
  Distribution yaw_deg = Uniform{-180, 180};
  double clearance_m = 0.3;       ///< radius free of occupied cells
  double least_seen_share = 0.1;  ///< of a coarse fan's rays that must meet something within the range window
  int tries = 200;                ///< then the frame fails and says so
};

struct Split {
  std::string name;  ///< train, val or test
  int frames = 0;    ///< over all places: random poses take the places in turn, trajectories one after the other
  std::variant<RandomPoses, TrajectoryPoses> poses;
  std::vector<PlaceRef> places;
};

/// Dead reckoning: horizontal position error whose mean radius is `radial_error_m` after `after_s` (see `drift.hpp`).
struct Drift {
  double radial_error_m = 1.1;
  double after_s = 1200;
};

/// Everything that a dataset follows from, but the seed.
struct Recipe {
  std::string name;
  std::string title;
  std::uint64_t seed = 0;
  std::string sonar;
  std::optional<double> range_min_m;
  std::optional<Distribution> range_max_m;
  std::optional<int> range_bins;       ///< 0: native
  Distribution gain_db = Constant{0};  ///< of the raw image over the nominal receive chain
  std::vector<std::string> noise;      ///< profiles; of several, each frame (each place, where one is swum) draws one
  int mask_threshold = 8;              ///< grey level
  bool cell_truth = false;             ///< write truth/*.exr
  std::vector<Split> splits;
  Drift drift;

  int frames() const;
};

/// Loads a recipe: its YAML, or the manifest of a set that was made of it. Scene, sonar and noise files are relative to
/// the recipe (for a manifest, to the working folder), or bundled names.
/// Throws ConfigError, also where two splits share a place; DataError where a trajectory file is broken.
Recipe load_recipe(const ConfigSource& source);

/// Other than the recipe's own number of training frames. Throws ConfigError where it has no split `train`, or where
/// the split could not have been read with that number.
void set_training_pairs(Recipe& recipe, int pairs);

}  // namespace ensonify
