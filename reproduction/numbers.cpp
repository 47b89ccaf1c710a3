#include "ensonify/reproduction/numbers.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ensonify/output/atomic_file.hpp"
#include "ensonify/reproduction/conclusions.hpp"

namespace ensonify {
namespace {

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

std::string loops_csv(const std::vector<LoopRun>& loops) {
  std::string text = "filter,scene,step,time_s,path_m,coverage,boundary_found,fpr,fnr\n";
  for (const LoopRun& run : loops) {
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      const LoopStep& s = run.steps[i];
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", run.filter, run.scene, i, number(s.time_s), number(s.path_m),
                          number(s.coverage), number(s.boundary_found), number(s.fpr), number(s.fnr));
    }
  }
  return text;
}

std::string times_csv(const Times& times) {
  std::string text = "what,name,median_s\n";
  for (const FilterTime& time : times.filters) text += fmt::format("filter,{},{}\n", time.label, number(time.s));
  for (const PingTime& time : times.pings) text += fmt::format("ping,{},{}\n", time.noise, number(time.s));
  return text;
}

void write_filters(const std::filesystem::path& folder, const std::string& name,
                   const std::optional<FilterReport>& report) {
  if (!report) return;
  write_file(folder / (name + ".csv"), scores_csv(*report));
  write_file(folder / (name + ".json"), scores_json(*report));
}

void write_maps(const std::filesystem::path& folder, const std::string& name, const std::optional<MapFindings>& found) {
  if (!found) return;
  write_file(folder / (name + ".csv"), map_scores_csv(found->report));
  write_file(folder / (name + "_summary.csv"), map_summary_csv(found->report));
  write_file(folder / (name + ".json"), map_scores_json(found->report));
}

}  // namespace

void write_numbers(const Findings& findings, const std::filesystem::path& folder) {
  write_filters(folder, "filters", findings.filters);
  write_filters(folder, "tank_filters", findings.tank_masks);
  write_filters(folder, "realistic_filters", findings.ghosts);
  write_maps(folder, "maps_as_the_paper", findings.maps_as_the_paper);
  write_maps(folder, "maps", findings.maps);
  write_maps(folder, "tank_maps", findings.tank_maps);
  write_file(folder / "closed_loop.csv", loops_csv(findings.loops));
  write_file(folder / "times.csv", times_csv(findings.times));
  write_file(folder / "conclusions.json", conclusions_json(conclusions_of(findings)));
}

}  // namespace ensonify
