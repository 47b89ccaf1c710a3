#include "ensonify/generators/tune_filters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/generators/split_frames.hpp"

namespace ensonify {

std::vector<std::vector<TunedStep>> tune_filters(const std::vector<Dataset>& datasets,
                                                 const std::vector<FilterGrid>& grids, const EvaluateOptions& options,
                                                 const OnProgress& on_progress) {
  std::vector<std::vector<TunedStep>> tuned;
  for (const FilterGrid& grid : grids) {
    auto& steps = tuned.emplace_back();
    for (const FilterStep& step : grid.steps) steps.push_back({step});
  }
  for (const Dataset& dataset : datasets) {
    const SplitFrames frames = choose_frames(dataset, "val", options.max_frames);
    std::vector<std::vector<LevelCounts>> counts;
    for (const auto& steps : tuned) counts.emplace_back(steps.size());
    std::mutex mutex;
    int done = 0;
    visit_frames(dataset, frames, [&](int, const JudgedFrame& frame) {
      for (std::size_t g = 0; g < tuned.size(); ++g) {
        for (std::size_t s = 0; s < tuned[g].size(); ++s) {
          const GreyImage out = apply(FilterChain{"", {tuned[g][s].step}}, frame.raw);
          const LevelCounts of_frame = count_levels(out.grey, frame.mask);
          const std::scoped_lock lock(mutex);
          counts[g][s] += of_frame;
        }
      }
      const std::scoped_lock lock(mutex);
      on_progress("tune " + dataset.name, ++done, static_cast<int>(frames.numbers.size()));
    });
    for (std::size_t g = 0; g < tuned.size(); ++g) {
      for (std::size_t s = 0; s < tuned[g].size(); ++s) {
        TunedStep& step = tuned[g][s];
        step.t = counts[g][s].best_threshold();
        step.iou += counts[g][s].at(step.t).iou() / static_cast<double>(datasets.size());
      }
    }
  }
  for (auto& steps : tuned) std::ranges::stable_sort(steps, std::ranges::greater{}, &TunedStep::iou);
  return tuned;
}

std::string tuning_csv(const std::vector<std::vector<TunedStep>>& tuned) {
  std::string text = "filter,settings,threshold,iou\n";
  for (const auto& steps : tuned) {
    for (const TunedStep& s : steps) {
      std::string settings;
      for (const auto& [key, value] : parameter_values(s.step))
        settings += fmt::format("{}{}={}", settings.empty() ? "" : " ", key, value);
      text += fmt::format("{},{},{},{:.6f}\n", name_of(s.step.method), settings, s.t, s.iou);
    }
  }
  return text;
}

}  // namespace ensonify
