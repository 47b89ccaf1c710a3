#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/core/pose.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// How a sonar moves, in its own frame: m/s and rad/s.
struct Twist {
  Vec3 velocity_mps = Vec3::Zero();
  Vec3 turn_radps = Vec3::Zero();

  bool still() const { return velocity_mps.isZero(0.0) && turn_radps.isZero(0.0); }
};

/// The echo as a sonar receives it that moves while the sound is under way. An echo of range r arrives 2 r / c after
/// the pulse, when the sonar is v t further and turned by w t: at half the length of its path, and at the bearing it
/// then has. Energy of a cell goes to the four cells about that place; what leaves the image is lost. Elevations are
/// those of elevation_rad, or 0 where that is empty, and 0 for multipath. First order in w t: a turn of some degrees at
/// most.
Echo receive_in_motion(const Echo& echo, const SonarGeometry& geometry, const Twist& motion, double sound_speed_mps);

}  // namespace ensonify
