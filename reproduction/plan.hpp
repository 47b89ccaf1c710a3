#pragma once

#include <string>

#include "ensonify/generators/recipe.hpp"

namespace ensonify {

/// What is made and measured, and how much of it.
struct ReproductionPlan {
  std::string scale;
  Recipe paper, realistic, tank;  ///< the bundled recipes' val and test alone
  bool all_filters = true;        ///< else those of the paper, and the strongest beside them
  int loop_steps = 0;             ///< pings of the closed loop
  int timed_frames = 0;
};

/// "quick": a tenth of the frames along the same trajectories, in minutes; "full": all frames. Throws ConfigError for
/// another name.
ReproductionPlan reproduction_plan(const std::string& scale);

}  // namespace ensonify
