#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ensonify/generators/frame.hpp"
#include "ensonify/python/bindings.hpp"

namespace ensonify::python {

/// One ping as Python sees it: arrays are views into it.
struct PyPing {
  SonarModel sonar;
  Pose T_world_sonar;
  PingImages images;
  std::optional<Image2<std::uint16_t>> raw16;  ///< of instruments of 16 bits
  Echo echo;
  PingTruth truth;
  SampledValues sampled;
};

/// A ping of a recipe.
struct PyFrame : PyPing {
  int index = 0, number = 0;  ///< -1 beyond the set
  std::string split, place, noise;
  std::optional<double> time_s;
  Pose T_world_sonar_est;
};

/// Called without the interpreter's lock.
std::unique_ptr<PyFrame> py_frame(const FrameMaker& maker, Frame&& frame);

}  // namespace ensonify::python
