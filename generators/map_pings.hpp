#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ensonify/core/posed_image.hpp"
#include "ensonify/generators/map_filter.hpp"

namespace ensonify {

/// Whose poses a map is made with.
enum class MapPoses { truth, drifted };

/// A frame as metadata.jsonl has it, as far as maps need it.
struct MapFrame {
  int number = 0;  ///< within the split
  double range_min_m = 0, range_max_m = 0;
  Pose T_world_sonar = Pose::Identity();
  Pose T_world_sonar_est = Pose::Identity();  ///< drifted

  const Pose& pose(MapPoses poses) const { return poses == MapPoses::truth ? T_world_sonar : T_world_sonar_est; }
};

/// The frames of one place, all or some, evenly spread.
struct PlacePings {
  int split = 0;
  std::string place;
  bool ordered = true;     ///< along a trajectory; false: random poses, which have no time
  SonarGeometry geometry;  ///< beams and field of view; the range window is the frame's
  std::vector<MapFrame> frames;
};

/// Places of the split that have frames, in the order of the frames. Throws ConfigError where there is no such split.
std::vector<std::string> places_with_frames(const Dataset& dataset, const std::string& split);

/// At most `max_frames` frames (0: all) of a place; its name may be empty where there is one. Throws ConfigError, which
/// names the places that there are, DataError for a frame without a pose in finite numbers.
PlacePings pings_of_place(const Dataset& dataset, const std::string& split, const std::string& place, int max_frames);

/// The geometry of frame `i`, whose image has so many rows.
SonarGeometry geometry_of(const PlacePings& pings, std::size_t i, int range_bins);

/// Whether the dataset holds the true elevations that the model oracle needs.
bool has_elevations(const Dataset& dataset, const PlacePings& pings);

/// Images of the frames through a filter, in their order, with their poses. With `elevations`, also those. Calls
/// one_done() after each frame, from one thread at a time. Throws DataError naming a file that is missing or broken.
std::vector<PosedImage> read_pings(const Dataset& dataset, const PlacePings& pings, const MapFilter& filter,
                                   MapPoses poses, bool elevations, const std::function<void()>& one_done);

/// Bytes that read_pings takes, once the size of images is known.
double bytes_of_pings(const Dataset& dataset, const PlacePings& pings, bool elevations);

}  // namespace ensonify
