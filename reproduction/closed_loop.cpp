#include "ensonify/reproduction/closed_loop.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/explore.hpp"
#include "ensonify/reproduction/contenders.hpp"
#include "ensonify/reproduction/kept.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::json;

constexpr const char* place = "test_tank";

double number(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::string run_loop(const ExploreChoice& choice, const FilterChain& filter, const std::function<void(int)>& at) {
  ExploreSettings settings = explore_settings(choice);
  settings.filter = filter;
  const Scene scene = open_scene(std::string(place));
  RangeWindow window;
  window.range_max_m = choice.range_max_m;
  const SonarModel sonar = load_sonar(choice.sonar, window);
  const Vehicle vehicle;
  const ExploreSite site = explore_site(scene, sonar, settings.model, vehicle, {});
  const Simulator simulator(scene, sonar, load_noise(choice.noise));
  ExploreHooks hooks;
  hooks.after_step = [&](const ExploreMoment& moment, const Slice&, const std::vector<ExploreStep>&) {
    at(moment.step + 1);
    return true;
  };
  const ExploreRun run = explore(simulator, site, vehicle, settings, hooks);
  json record{{"end", name_of(run.end)}, {"steps", json::array()}};
  for (const ExploreStep& s : run.steps) {
    record["steps"].push_back(
        {s.time_s, s.path_m, s.scores.coverage, s.scores.boundary_found, s.scores.fpr, s.scores.fnr});
  }
  return record.dump();
}

LoopRun run_of(const std::string& text, const std::string& filter, const fs::path& file) {
  LoopRun run{filter, place, "", {}};
  try {
    const json record = json::parse(text);
    run.end = record.at("end");
    for (const json& s : record.at("steps")) {
      run.steps.push_back(
          {number(s.at(0)), number(s.at(1)), number(s.at(2)), number(s.at(3)), number(s.at(4)), number(s.at(5))});
    }
  } catch (const json::exception& e) {
    throw DataError(
        fmt::format("{}: is no whole record ({}); delete it, and it is made anew", file.string(), e.what()));
  }
  return run;
}

}  // namespace

std::vector<LoopRun> close_loops(const std::vector<FilterChain>& filters, int steps, const fs::path& kept,
                                 const OnProgress& on_progress) {
  std::vector<LoopRun> runs;
  for (const FilterChain& filter : filters) {
    ExploreChoice choice;
    choice.filter = "none";
    choice.steps = steps;
    const fs::path file = kept / (filter.name + ".json");
    const FindingKey key = fmt::format("loop 1; {} {} {}; {} {}; {} steps", place, choice.sonar, choice.noise,
                                       filter.name + " " + fingerprint(filter), choice.model, steps);
    const std::string text = kept_or(file, key, [&] {
      return run_loop(choice, filter, [&](int step) { on_progress("closed loop, " + filter.name, step, steps); });
    });
    runs.push_back(run_of(text, filter.name, file));
  }
  return runs;
}

}  // namespace ensonify
