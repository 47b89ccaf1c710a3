#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/reproduction/contenders.hpp"
#include "ensonify/reproduction/few_pairs.hpp"
#include "ensonify/reproduction/map_study.hpp"

namespace ensonify {

/// What is not there, and why.
struct Missing {
  std::string what, why;
};

/// Where studies keep what they find, and whom they tell how far they are.
struct Desk {
  std::filesystem::path kept;
  OnProgress on_progress;
};

/// Why filters can not be judged on a dataset: it lacks a split.
std::optional<Missing> lack_of_splits(const Dataset& dataset);

/// Places of the split test without truth to score maps on, and where there is none at all, maps as a whole.
std::vector<Missing> lacks_of_truth(const Dataset& dataset);

/// evaluate_filters over all frames, kept under `name`.
FilterReport judge(const Desk& desk, const std::string& name, const Dataset& dataset,
                   const std::vector<FilterCandidate>& candidates, const std::vector<FewPairsModel>& few_pairs);

/// Maps of every contender by the paper's model, from images that were sharpened and equalised as in the paper.
MapFindings map_as_the_paper(const Desk& desk, const Dataset& dataset, const std::vector<Contender>& contenders);

/// The same of the filtered images as they are, also with drifted poses; raw image, wavelet, learned and true mask by
/// the other inverse models too.
MapFindings map_contenders(const Desk& desk, const Dataset& dataset, const std::vector<Contender>& contenders);

/// The paper's filters and the networks from few pairs, as filters and before the mapper, in the tank.
std::vector<FilterCandidate> tank_candidates(const std::vector<Contender>& contenders,
                                             const std::vector<FewPairsModel>& models);
MapFindings map_tank(const Desk& desk, const Dataset& tank, const std::vector<Contender>& contenders,
                     const std::vector<FewPairsModel>& models);

}  // namespace ensonify
