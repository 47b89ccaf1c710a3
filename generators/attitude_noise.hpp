#pragma once

#include "ensonify/core/random.hpp"
#include "ensonify/generators/trajectory_spec.hpp"

namespace ensonify {

/// Roll, pitch and yaw (rad) by which the vehicle rocks at `time_s`. Each axis is a sum of 16 cosines of equal
/// amplitude and random phase, one in each sixteenth of the band 0.5 / period .. 1.5 / period: a flat spectrum over
/// that band, zero mean, the rms of the settings, smooth. Its rate has an rms of 2 pi sqrt(13 / 12) rms / period. A
/// pure function of key and time.
Vec3 rocking_rad(const AttitudeNoise& noise, RandomKey key, double time_s);

}  // namespace ensonify
