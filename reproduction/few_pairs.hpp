#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ensonify/filters/filter_chain.hpp"

namespace ensonify {

/// A network of docs/learned_filter.md, "From few pairs".
struct FewPairsModel {
  std::string name;   ///< tank_25 .. tank_3000, paper_small, transfer
  std::string label;  ///< for readers
  int pairs = 0;      ///< of the tank that it was trained on
  std::filesystem::path onnx;
  std::string sha256;
};

/// Those that are in `folder` as scripts/train_models leaves them (NAME/model.onnx), else those that are bundled; in
/// the order of that page.
std::vector<FewPairsModel> few_pairs_models(const std::optional<std::filesystem::path>& folder);

/// The network as a filter: probability times 255, or the mask at its card's threshold.
FilterChain probability_of(const FewPairsModel& model);
FilterChain mask_of(const FewPairsModel& model);

}  // namespace ensonify
