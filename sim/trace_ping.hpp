#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/sim/multipath.hpp"
#include "ensonify/sim/ping_motion.hpp"
#include "ensonify/sim/ray_fan.hpp"
#include "ensonify/sim/ray_scene.hpp"

namespace ensonify {

struct Ping {
  Echo echo;
  PingTruth truth;
};

/// What a trace gives beside the direct echo.
struct TraceOptions {
  bool cell_truth = false;         ///< the images of elevation, incidence and instance in the truth
  bool elevation = false;          ///< Echo::elevation_rad, which coherent speckle needs
  Twist motion{};                  ///< while the sound is under way; truth stays that of the moment of the pulse
  int multipath_order = 0;         ///< Echo::multipath: surfaces that a path may meet, 2 or 3; 0: none
  double multipath_samples = 1.0;  ///< of multipath, over the usual: more for less noise
};

/// Casts one ping: mean echo intensity of the direct path, before the point spread, and the truth of the same rays.
///
/// A cell of the fan of solid angle dOmega that meets a surface at range r and incidence i adds (Urick 1983, sonar
/// equation, with dA = r^2 dOmega / cos i)
///     B_tx B_rx sigma(i) / cos(i) dOmega  r^-2 10^(-2 alpha r / 10)
/// spread over the ranges that its footprint covers: on the tangent plane of the hit, not beyond the neighbouring
/// rays' hits, falling as r^-3 as a Lambert plane does and with the flank of the pattern. So a plane's echo does not
/// depend on the ray count.
class PingTracer {
 public:
  /// The scene must outlive the tracer.
  PingTracer(const RayScene& scene, const SonarModel& sonar, const Water& water);

  Ping trace(const Pose& T_world_sonar, const TraceOptions& options = {}) const;

  const RayFan& fan() const { return fan_; }

 private:
  PingTruth empty_truth() const;

  const RayScene* scene_;
  SonarGeometry geometry_;
  double sound_speed_mps_;
  RayFan fan_;
  MultipathTracer multipath_;
  std::vector<float> row_loss_;  ///< r^-2 and absorption of every bin
};

}  // namespace ensonify
