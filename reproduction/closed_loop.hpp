#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ensonify/generators/evaluate_filters.hpp"

namespace ensonify {

struct LoopStep {
  double time_s = 0, path_m = 0, coverage = 0, boundary_found = 0, fpr = 0, fnr = 0;
};

/// A run of the closed loop (docs/explore.md) behind one filter.
struct LoopRun {
  std::string filter, scene, end;
  std::vector<LoopStep> steps;
};

/// At most so many pings through the bundled test tank, seed 0, behind each filter; a run that was done before is read
/// from `kept`.
std::vector<LoopRun> close_loops(const std::vector<FilterChain>& filters, int steps, const std::filesystem::path& kept,
                                 const OnProgress& on_progress);

}  // namespace ensonify
