#include "ensonify/reproduction/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

/// The val and test splits of a bundled recipe, every `every`-th frame of their trajectories.
Recipe held_out(const std::string& name, int every) {
  Recipe recipe = load_recipe(name);
  std::erase_if(recipe.splits, [](const Split& split) { return split.name == "train"; });
  for (Split& split : recipe.splits) {
    split.frames = std::max(split.frames / every, static_cast<int>(split.places.size()));
    if (auto* swum = std::get_if<TrajectoryPoses>(&split.poses)) swum->rate_hz /= every;
  }
  recipe.name = every == 1 ? fmt::format("{}_held_out", name) : fmt::format("{}_held_out_{}th", name, every);
  recipe.title = fmt::format("val and test of the recipe {}{}", name,
                             every == 1 ? "" : fmt::format(", every {}th frame of the trajectories", every));
  return recipe;
}

}  // namespace

ReproductionPlan reproduction_plan(const std::string& scale) {
  if (scale == "quick") {
    return {scale, held_out("paper", 10), held_out("realistic", 20), held_out("tank", 10), false, 60, 3};
  }
  if (scale == "full")
    return {scale, held_out("paper", 1), held_out("realistic", 5), held_out("tank", 2), true, 400, 20};
  throw ConfigError(fmt::format("--scale {}: is quick or full", scale));
}

}  // namespace ensonify
