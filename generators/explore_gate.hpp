#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/generators/explore.hpp"

namespace ensonify {

/// Bounds that a run must keep; those left out do not count.
struct ExploreGate {
  std::optional<double> coverage_at_least, fpr_at_most, fnr_at_most, clearance_at_least_m;
  std::optional<int> within_steps;  ///< the run is judged by its first so many pings; else by all
};

/// Reads the YAML keys of the same names. Throws ConfigError: unknown keys, shares outside 0..1, no bound at all.
ExploreGate load_gate(const std::filesystem::path& path);

struct GateLine {
  std::string text;  ///< "gate: coverage 0.9312 >= 0.9: passed"
  bool passed = false;
};

/// Coverage, FPR and FNR after the last ping that counts, the least clearance until then. A score that is 0 / 0 fails.
std::vector<GateLine> judge(const ExploreGate& gate, const std::vector<ExploreStep>& steps);
bool all_passed(const std::vector<GateLine>& lines);

}  // namespace ensonify
