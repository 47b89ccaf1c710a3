#pragma once

#include "ensonify/core/image2.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/noise/noise_chain.hpp"

namespace ensonify {

/// Runs the stages of a chain that act on the image: levels 0..1 (rows = bins, columns = beams); the result is clipped
/// to 0..1. Numbers are addressed by (key, stage, bin, beam): a stage that is switched off changes no other stage's
/// numbers.
Image2<float> disturb_image(const NoiseChain& chain, Image2<float> level, const SonarGeometry& geometry, RandomKey key);

}  // namespace ensonify
