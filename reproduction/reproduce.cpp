#include "ensonify/reproduction/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/core/error.hpp"
#include "ensonify/generators/generate.hpp"
#include "ensonify/generators/ping_series.hpp"
#include "ensonify/generators/report_source.hpp"
#include "ensonify/reproduction/plan.hpp"

namespace ensonify {
namespace {

/// Before minutes of work.
void check_folders(const ReproduceOptions& options) {
  if (options.data) open_dataset(*options.data);
  if (options.real) open_pings(*options.real, "test");
  if (options.models && !std::filesystem::is_directory(*options.models)) {
    throw ConfigError(
        fmt::format("--models {}: is no folder; scripts/train_models leaves one", options.models->string()));
  }
}

std::vector<Missing> lacks_of_models(const ReproduceOptions& options, const std::vector<FewPairsModel>& few_pairs) {
  std::vector<Missing> lacks;
  for (const char* name : {"paper", "realistic"}) {
    if (has_model(name)) continue;
    lacks.push_back({fmt::format("the learned filter for the noise of {}", name),
                     fmt::format("no model {}.onnx is bundled with this program", name)});
  }
  if (few_pairs.empty()) {
    lacks.push_back({"the tank and sample efficiency",
                     options.models ? "the folder of --models has none of the networks of scripts/train_models"
                                    : "no networks from few pairs are bundled; scripts/train_models makes them, and "
                                      "--models says where they are"});
  }
  return lacks;
}

Dataset made(const ReproduceOptions& options, const Recipe& recipe, const std::string& name) {
  GenerateOptions how;
  how.out = options.out / ("data_" + options.scale) / name;
  how.command_line = fmt::format("ensonify reproduce --scale {}", options.scale);
  how.on_progress = [&](const Progress& p) {
    options.on_progress(fmt::format("data {}, {}", name, p.stage), p.done, p.total);
  };
  generate(recipe, how);
  return open_dataset(how.out);
}

/// The contenders as pictures: what each hands on.
std::vector<FilterCandidate> shown(const std::vector<Contender>& contenders) {
  std::vector<FilterCandidate> candidates;
  for (const Contender& contender : contenders) {
    if (contender.kind == Contender::Kind::truth) continue;
    candidates.push_back({contender.label, "paper", chain_for_maps(chain_of(contender), false)});
  }
  return candidates;
}

/// The same before the mapper of the closed loop, and the median that its default is.
std::vector<FilterChain> before_the_loop(const std::vector<Contender>& contenders) {
  std::vector<FilterChain> chains{find_filter("median")};
  for (const Contender& contender : contenders) {
    const bool chosen =
        contender.label == "raw" || contender.label == "wavelet" || contender.kind == Contender::Kind::learned;
    if (chosen) chains.push_back({contender.label, chain_for_maps(chain_of(contender), false).steps});
  }
  return chains;
}

/// With the network at the threshold of its card too: the val split of few draws of noise chooses poorly.
std::vector<FilterCandidate> for_real_acoustics(bool all) {
  std::vector<FilterCandidate> chosen = candidates(all, {"realistic"});
  if (has_model("realistic")) chosen.push_back({"unet at its card's threshold", "realistic", find_filter("unet")});
  return chosen;
}

}  // namespace

Findings reproduce(const ReproduceOptions& options) {
  const ReproductionPlan plan = reproduction_plan(options.scale);
  const Desk desk{options.out / ("kept_" + plan.scale), options.on_progress};
  check_folders(options);
  Findings found;
  found.scale = plan.scale;
  found.contenders = contenders();
  found.few_pairs = few_pairs_models(options.models);
  found.missing = lacks_of_models(options, found.few_pairs);
  const auto lacks = [&](const Missing& lack) { found.missing.push_back(lack); };

  found.sonar = sonar_pictures();
  const Dataset paper = options.data ? open_dataset(*options.data) : made(options, plan.paper, "paper");
  found.paper_source = report_source(paper);
  if (const auto lack = lack_of_splits(paper)) {
    lacks(*lack);
  } else {
    found.filters = judge(desk, "filters", paper, candidates(plan.all_filters, {"paper"}), {});
    found.frames = filter_sheet(paper, shown(found.contenders));
    found.times = measure_times(paper, found.contenders, plan.timed_frames);
  }
  const std::vector<Missing> without_truth = lacks_of_truth(paper);
  std::ranges::for_each(without_truth, lacks);
  if (std::ranges::find(without_truth, "maps", &Missing::what) == without_truth.end()) {
    found.maps_as_the_paper = map_as_the_paper(desk, paper, found.contenders);
    found.maps = map_contenders(desk, paper, found.contenders);
  }
  if (!found.few_pairs.empty()) {
    const Dataset tank = made(options, plan.tank, "tank");
    found.tank_source = report_source(tank);
    found.tank_masks =
        judge(desk, "tank_filters", tank, tank_candidates(found.contenders, found.few_pairs), found.few_pairs);
    found.tank_maps = map_tank(desk, tank, found.contenders, found.few_pairs);
  }
  const Dataset realistic = made(options, plan.realistic, "realistic");
  found.realistic_source = report_source(realistic);
  found.ghosts = judge(desk, "realistic_filters", realistic, for_real_acoustics(plan.all_filters), {});

  found.loops =
      close_loops(before_the_loop(found.contenders), plan.loop_steps, desk.kept / "loops", options.on_progress);
  if (options.real) {
    found.real = beside_real_pings(*options.real, options.out / "like_real");
  } else {
    lacks({"real pings", "no folder of them was named (--real FOLDER)"});
  }
  return found;
}

}  // namespace ensonify
