#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/output/contact_sheet.hpp"

namespace ensonify {

struct FilterCandidate {
  std::string name, preset;
  FilterChain chain;  ///< no steps: the raw image
};

/// The raw image, then every despeckler and detector: with its defaults (preset "paper"), and as the preset `tuned` has
/// it; learned ones with every bundled model (whose name is the preset).
std::vector<FilterCandidate> all_candidates(const FilterPreset& tuned);

struct EvaluateOptions {
  int max_frames = 0;  ///< of a split, spread evenly over its places; 0: all
};

using OnProgress = std::function<void(const std::string& stage, int done, int total)>;

/// Masks of the val split choose every candidate's threshold; the test split gives the scores. The last filter reported
/// is `truth_mask`: the true mask applied to the raw image. Throws ConfigError where the dataset has no val or test
/// split.
FilterReport evaluate_filters(const Dataset& dataset, const std::vector<FilterCandidate>& candidates,
                              const EvaluateOptions& options, const OnProgress& on_progress);

/// The middle frame of every place of the test split through all candidates, with clean and mask.
ContactSheet filter_sheet(const Dataset& dataset, const std::vector<FilterCandidate>& candidates);

}  // namespace ensonify
