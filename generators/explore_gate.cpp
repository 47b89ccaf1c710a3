#include "ensonify/generators/explore_gate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/config/reader.hpp"

namespace ensonify {

ExploreGate load_gate(const std::filesystem::path& path) {
  Reader reader = Reader::from_file(path);
  ExploreGate gate;
  const auto bound = [&](std::string_view key, Limits limits, std::optional<double>& value) {
    if (reader.has(key)) value = reader.number(key, limits);
  };
  bound("coverage_at_least", {0, 1}, gate.coverage_at_least);
  bound("fpr_at_most", {0, 1}, gate.fpr_at_most);
  bound("fnr_at_most", {0, 1}, gate.fnr_at_most);
  bound("clearance_at_least_m", {0, clearance_far_m}, gate.clearance_at_least_m);
  if (reader.has("within_steps")) gate.within_steps = reader.integer("within_steps", 1, 1'000'000);
  reader.finish();
  if (!gate.coverage_at_least && !gate.fpr_at_most && !gate.fnr_at_most && !gate.clearance_at_least_m) {
    reader.fail("", "holds no bound; give coverage_at_least, fpr_at_most, fnr_at_most or clearance_at_least_m");
  }
  return gate;
}

std::vector<GateLine> judge(const ExploreGate& gate, const std::vector<ExploreStep>& steps) {
  const auto count = std::min(steps.size(), static_cast<std::size_t>(gate.within_steps.value_or(1'000'000'000)));
  const ExploreStep& last = steps.at(count - 1);
  double clearance = clearance_far_m;
  for (std::size_t i = 0; i < count; ++i) clearance = std::min(clearance, steps[i].clearance_m);
  std::vector<GateLine> lines;
  const auto at_least = [&](const char* name, double value, std::optional<double> bound) {
    if (!bound) return;
    const bool passed = value >= *bound;
    lines.push_back(
        {fmt::format("gate: {} {:.4f} >= {}: {}", name, value, *bound, passed ? "passed" : "failed"), passed});
  };
  const auto at_most = [&](const char* name, double value, std::optional<double> bound) {
    if (!bound) return;
    const bool passed = value <= *bound;
    lines.push_back(
        {fmt::format("gate: {} {:.4f} <= {}: {}", name, value, *bound, passed ? "passed" : "failed"), passed});
  };
  at_least("coverage", last.scores.coverage, gate.coverage_at_least);
  at_most("fpr", last.scores.fpr, gate.fpr_at_most);
  at_most("fnr", last.scores.fnr, gate.fnr_at_most);
  at_least("clearance_m", clearance, gate.clearance_at_least_m);
  return lines;
}

bool all_passed(const std::vector<GateLine>& lines) { return std::ranges::all_of(lines, &GateLine::passed); }

}  // namespace ensonify
