#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/generators/evaluate_filters.hpp"
#include "ensonify/generators/map_filter.hpp"

namespace ensonify {

/// A filter of Lin et al. (ICRA 2023), or what stands for it here.
struct Contender {
  enum class Kind { raw, classical, learned, truth };
  std::string label;  ///< for readers, and of its maps
  Kind kind = Kind::classical;
  std::string method, preset;                                ///< of its row in a FilterReport
  Estimate FilterScores::*psnr_db = &FilterScores::psnr_db;  ///< of the image that it hands on
  std::optional<double> paper_s = {};                        ///< a frame, as the paper reports it
};

/// Raw image; the paper's four, with its parameters; the learned mask applied to the raw image, which is the paper's
/// own filter, and the clean image of the same network; the raw image under the true mask. The learned ones only where
/// the model `paper` is bundled.
std::vector<Contender> contenders();

/// The row of a contender in a scene ("all": every one); null where the report has none.
const FilterScores* row_of(const FilterReport& report, const Contender& contender, const std::string& scene);

/// Its way from an image to what the mapper takes, named by its label; `post_process` adds the paper's unsharp filter
/// and histogram equalisation.
MapFilter map_filter_of(const Contender& contender, bool post_process);

/// The chain that a frame goes through, without what follows; no steps for raw and truth.
FilterChain chain_of(const Contender& contender);

/// A word for a chain's methods with their parameters: two that differ have two.
std::string fingerprint(const FilterChain& chain);

/// What filters are judged: all that the program has, or, in short, those of the paper with both presets, the classical
/// one that is best at this noise, and the learned ones. `models`: those of them that are judged.
std::vector<FilterCandidate> candidates(bool all, const std::vector<std::string>& models);

/// Bundled models, by name.
std::vector<std::string> bundled_models();
bool has_model(const std::string& name);

}  // namespace ensonify
