#pragma once

#include "ensonify/core/image2.hpp"
#include "ensonify/sim/path_fan.hpp"
#include "ensonify/sim/path_tiles.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

/// Traces multipath: the mean intensity of paths that meet two surfaces (order 2: sonar - A - B - sonar), or two and
/// three, in the units of Echo::direct, before the point spread. A path is received at the bearing of its last leg and
/// at half its length, and is travelled in both directions. See `path_pair` for the sum, `SurfaceLaw` for what surfaces
/// do.
///
/// Deterministic in the pose: a sonar that stands still sees the same multipath in every ping.
///
/// Limits: intensities add (no interference of a path with its reverse, which would double the mean of the two where
/// they meet in one beam); ends of paths lie within the fan, where the two-way pattern exceeds -60 dB; a path of three
/// surfaces is only found by walks, with more noise.
class MultipathTracer {
 public:
  /// The scene must outlive the tracer.
  MultipathTracer(const RayScene& scene, const SonarModel& sonar, const Water& water);
  /// With the sonar's fan at hand.
  MultipathTracer(const RayScene& scene, const SonarModel& sonar, const RayFan& fan, const Water& water);

  /// Bins x beams. `order`: 2 or 3. `samples`: pairs of places that are tried, over the usual; rays grow as its square
  /// root. Throws ConfigError for others.
  Image2<float> trace(const Pose& T_world_sonar, int order, double samples = 1.0) const;

 private:
  const RayScene* scene_;
  SonarGeometry geometry_;
  PathFan fan_;
  std::vector<float> row_loss_;  ///< absorption of every bin
};

}  // namespace ensonify
