#pragma once

#include <string>
#include <vector>

#include "ensonify/reproduction/contenders.hpp"

namespace ensonify {

/// Medians by this computer's clock; no two runs have the same.
struct FilterTime {
  std::string label;
  double s = 0;  ///< a frame, alone, on all cores that it can use
};
struct PingTime {
  std::string noise;
  double s = 0;  ///< a ping of 512 x 512, all its images, alone, on all cores
};
struct Times {
  std::vector<FilterTime> filters;
  std::vector<PingTime> pings;
};

/// Filters on the first frames of the split test, pings on the way through the bundled pier.
Times measure_times(const Dataset& dataset, const std::vector<Contender>& contenders, int frames);

}  // namespace ensonify
