#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ensonify/generators/form_images.hpp"
#include "ensonify/generators/place.hpp"
#include "ensonify/generators/recipe.hpp"
#include "ensonify/generators/trajectory.hpp"
#include "ensonify/sim/trace_ping.hpp"

namespace ensonify {

/// Where a frame stands in its dataset and where its sonar stood.
struct FramePose {
  int index = 0;                 ///< over the whole dataset
  int split = 0;                 ///< index into Recipe::splits
  int number = 0;                ///< within the split: its file name
  int place = 0;                 ///< over all splits' places in order
  int noise = 0;                 ///< index into FrameMaker::noises
  std::optional<double> time_s;  ///< empty for random poses
  Pose T_world_sonar = Pose::Identity();
  Pose T_world_sonar_est = Pose::Identity();
  Twist motion;  ///< while the sound is under way, where the split asks for it
  SampledValues sampled;
};

struct Frame {
  FramePose pose;
  SonarModel sonar;
  PingImages images;
  PingTruth truth;
  Echo echo;
};

/// Makes frames of a recipe: a pure function of (recipe, index); places are built when first needed and kept.
/// Any number of threads may call at once.
class FrameMaker {
 public:
  /// Loads sonar and noise. Throws ConfigError.
  FrameMaker(Recipe recipe, std::string isa);
  ~FrameMaker();

  const Recipe& recipe() const { return recipe_; }
  const SonarModel& sonar() const { return receiver_.sonar; }
  const std::vector<NoiseProfile>& noises() const { return noises_; }
  const std::vector<PlaceRef>& places() const { return places_; }
  /// Builds the place if need be.
  const Place& place(int index) const;
  /// What is swum in a place, and until when; empty where poses are random. Builds the place if need be.
  const Trajectory* trajectory(int place) const;
  double swum_until_s(int place) const;
  /// Looks along the whole path that the frames of a place follow, between the frames too. Throws ConfigError where it
  /// runs into something, or where a recorded path ends too early.
  void check_trajectory(int place) const;

  /// Split, number, place and noise profile of a frame, without its pose.
  FramePose locate(int index) const;
  /// The instrument as it is set in a frame of the set.
  SonarModel sonar_for(int index) const;
  /// Pose of a frame, without its ping. Throws DataError where no random pose keeps the rules, ConfigError where the
  /// trajectory is inside of something at that time.
  FramePose pose(int index) const;
  /// Of a frame of the set.
  Ping ping(const FramePose& pose, const TraceOptions& options = {}) const;
  Frame make(int index) const;

  /// A frame beyond the set: place, pose, settings and noise drawn with `frame`; scatterers and device are those that
  /// `seed` names. A pure function of split and keys. Throws ConfigError where the split follows trajectories.
  Frame draw(int split, RandomKey seed, RandomKey frame) const;

  /// Frees the ray casters, most of what a place takes, once no more frames are made. Afterwards a place is its truth
  /// and its trajectory, and neither pings nor random poses may be asked for. Not while another thread uses the maker.
  void end_pings();

 private:
  struct Slot;
  struct Keys {
    RandomKey set, frame, settings;
  };
  Frame form(FramePose pose, const Keys& keys) const;
  FramePose random_pose(FramePose frame, RandomKey key) const;
  int first_place_of(int split) const;
  SonarModel sonar_drawn(RandomKey settings, SampledValues& sampled) const;
  Ping trace(const FramePose& pose, const SonarModel& sonar, const TraceOptions& options) const;
  RandomKey frame_key(int index) const;
  RandomKey settings_key(const FramePose& frame) const;
  const Slot& slot(int place) const;
  const Split& split_of_place(int place) const;
  [[noreturn]] void refuse_short(int place) const;
  [[noreturn]] void refuse_obstructed(int place, const Obstruction& at) const;

  Recipe recipe_;
  std::string isa_;
  Receiver receiver_;
  std::vector<NoiseProfile> noises_;
  std::vector<PlaceRef> places_;
  std::unique_ptr<Slot[]> slots_;
  bool pings_ended_ = false;
};

}  // namespace ensonify
