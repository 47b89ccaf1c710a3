#include "ensonify/generators/evaluate_filters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <mutex>

#include "ensonify/config/library.hpp"
#include "ensonify/core/error.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/generators/split_frames.hpp"

namespace ensonify {
namespace {

constexpr int picture_rows = 160, picture_columns = 160;

/// Counts progress of several threads.
class Counter {
 public:
  Counter(const OnProgress& on_progress, std::string stage, int total)
      : on_progress_(on_progress), stage_(std::move(stage)), total_(total) {}
  void one() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    on_progress_(stage_, done_, total_);
  }

 private:
  const OnProgress& on_progress_;
  std::string stage_;
  int total_, done_ = 0;
  std::mutex mutex_;
};

std::vector<int> choose_thresholds(const Dataset& dataset, const SplitFrames& frames,
                                   const std::vector<FilterCandidate>& candidates, const OnProgress& on_progress) {
  std::vector<LevelCounts> counts(candidates.size());
  std::mutex mutex;
  Counter counter(on_progress, "val", static_cast<int>(frames.numbers.size()));
  visit_frames(dataset, frames, [&](int, const JudgedFrame& frame) {
    std::vector<LevelCounts> of_frame;
    for (const FilterCandidate& candidate : candidates) {
      of_frame.push_back(count_levels(apply(candidate.chain, frame.raw).grey, frame.mask));
    }
    {
      const std::scoped_lock lock(mutex);
      for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += of_frame[i];
    }
    counter.one();
  });
  std::vector<int> thresholds;
  for (const LevelCounts& levels : counts) {
    thresholds.push_back(levels.best_threshold());
  }
  return thresholds;
}

FrameTruth truth_of(const JudgedFrame& frame) { return {frame.raw.grey, frame.clean, frame.mask, frame.labels}; }

FrameScores judge(const FilterCandidate& candidate, int t, const JudgedFrame& frame) {
  const auto begin = std::chrono::steady_clock::now();
  const GreyImage filtered = apply(candidate.chain, frame.raw);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  FrameScores scores = score_frame(filtered.grey, truth_of(frame), t);
  scores.time_ms = 1e3 * seconds;
  return scores;
}

/// The upper bound of every mask: the true one as a filter's output.
FrameScores judge_truth(const JudgedFrame& frame) {
  Image2<float> masked = frame.raw.grey;
  for (std::size_t i = 0; i < masked.size(); ++i) {
    if (frame.mask.pixels()[i] == 0) masked.pixels()[i] = 0.0F;
  }
  FrameScores scores = score_frame(to_grey(frame.mask).grey, truth_of(frame), 1);
  const FrameScores of_image = score_frame(masked, truth_of(frame), 1);
  scores.psnr_db = scores.gated_psnr_db = of_image.psnr_db;
  scores.ssim = of_image.ssim;
  scores.edge_preservation = of_image.edge_preservation;
  scores.looks = of_image.looks;
  return scores;
}

/// A learned method with every bundled model that goes with it. Probabilities instead of masks, so that thresholds are
/// chosen on the dataset as for all others.
std::vector<FilterCandidate> learned_candidates(const MethodInfo& method) {
  std::vector<FilterCandidate> candidates;
  for (const std::string& model : library_names("filters/models", ".onnx")) {
    FilterStep step = make_filter(method.name);
    set_parameter(step, "model", model);
    if (method.role == FilterRole::detects) set_parameter(step, "output", "probability");
    try {
      check_filter(step);
    } catch (const ConfigError&) {
      continue;  // of another network, or without such an output
    }
    candidates.push_back({method.name, model, {method.name, {std::move(step)}}});
  }
  return candidates;
}

}  // namespace

std::vector<FilterCandidate> all_candidates(const FilterPreset& tuned) {
  std::vector<FilterCandidate> candidates{{"raw", "", {"raw", {}}}};
  for (const MethodInfo& method : filter_methods()) {
    if (method.role == FilterRole::finishes || method.name == "threshold") continue;
    if (std::ranges::find(method.parameters, "model", &ParameterInfo::name) != method.parameters.end()) {
      std::ranges::move(learned_candidates(method), std::back_inserter(candidates));
      continue;
    }
    candidates.push_back({method.name, "paper", {method.name, {make_filter(method.name)}}});
    if (const auto found = tuned.methods.find(method.name); found != tuned.methods.end()) {
      candidates.push_back({method.name, tuned.name, {method.name, {found->second}}});
    }
  }
  return candidates;
}

FilterReport evaluate_filters(const Dataset& dataset, const std::vector<FilterCandidate>& candidates,
                              const EvaluateOptions& options, const OnProgress& on_progress) {
  const SplitFrames val = choose_frames(dataset, "val", options.max_frames);
  const SplitFrames test = choose_frames(dataset, "test", options.max_frames);
  const std::vector<int> thresholds = choose_thresholds(dataset, val, candidates, on_progress);

  std::vector<std::vector<FrameScores>> scores(candidates.size() + 1, std::vector<FrameScores>(test.numbers.size()));
  Counter counter(on_progress, "test", static_cast<int>(test.numbers.size()));
  visit_frames(dataset, test, [&](int at, const JudgedFrame& frame) {
    const auto keep = [&](std::size_t candidate, FrameScores of_frame) {
      of_frame.frame = frame.number;
      of_frame.scene = frame.scene;
      scores[candidate][static_cast<std::size_t>(at)] = std::move(of_frame);
    };
    for (std::size_t i = 0; i < candidates.size(); ++i) keep(i, judge(candidates[i], thresholds[i], frame));
    keep(candidates.size(), judge_truth(frame));
    counter.one();
  });

  FilterReport report{
      dataset.name, dataset.root_hash, static_cast<int>(val.numbers.size()), static_cast<int>(test.numbers.size()), {}};
  const auto add = [&](const std::string& filter, const std::string& preset, int t,
                       const std::vector<FrameScores>& frames) {
    for (FilterScores& row : pool_scores(filter, preset, t, frames)) report.rows.push_back(std::move(row));
  };
  for (std::size_t i = 0; i < candidates.size(); ++i)
    add(candidates[i].name, candidates[i].preset, thresholds[i], scores[i]);
  add("truth_mask", "", 1, scores.back());
  return report;
}

ContactSheet filter_sheet(const Dataset& dataset, const std::vector<FilterCandidate>& candidates) {
  const SplitFrames frames = middle_frames(dataset, "test");
  std::vector<std::array<ContactRow, 2>> rows(frames.numbers.size());  // of a frame: the paper's parameters, all others
  visit_frames(dataset, frames, [&](int at, const JudgedFrame& frame) {
    auto& [first, second] = rows[static_cast<std::size_t>(at)];
    first.label = fmt::format("{}   frame {}", frame.scene, frame.number);
    second.label = "other parameters";
    const auto add = [](ContactRow& row, const std::string& caption, const Image2<float>& image) {
      Image2<std::uint8_t> grey(image.rows(), image.columns());
      std::ranges::transform(image.pixels(), grey.pixels().begin(), [](float x) {
        return static_cast<std::uint8_t>(std::lrint(std::clamp(x, 0.0F, 255.0F)));
      });
      row.tiles.push_back({caption, {resized(grey, picture_rows, picture_columns)}});
    };
    add(first, "clean", frame.clean);
    add(first, "mask", to_grey(frame.mask).grey);
    for (const FilterCandidate& candidate : candidates) {
      const bool usual = candidate.name == "raw" || candidate.preset == "paper";
      add(usual ? first : second, candidate.name + (usual ? "" : " " + candidate.preset),
          apply(candidate.chain, frame.raw).grey);
    }
  });
  ContactSheet sheet{"a frame of every test scene through all filters, range downwards", {}};
  for (auto& of_frame : rows) {
    for (ContactRow& row : of_frame) {
      if (!row.tiles.empty()) sheet.rows.push_back(std::move(row));
    }
  }
  return sheet;
}

}  // namespace ensonify
