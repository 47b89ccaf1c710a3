#include "ensonify/reproduction/few_pairs.hpp"

#include <array>

#include "ensonify/config/library.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/output/sha256.hpp"

namespace ensonify {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char *name, *label;
  int pairs;
};

constexpr std::array known{Known{"paper_small", "paper noise only", 0},
                           Known{"tank_25", "25 pairs", 25},
                           Known{"tank_50", "50 pairs", 50},
                           Known{"tank_100", "100 pairs", 100},
                           Known{"tank_300", "300 pairs", 300},
                           Known{"tank_1000", "1000 pairs", 1000},
                           Known{"tank_3000", "3000 pairs", 3000},
                           Known{"transfer", "paper noise and 100 pairs", 100}};

FilterChain unet_of(const FewPairsModel& model, const char* output) {
  FilterStep step = make_filter("unet");
  set_parameter(step, "model", model.onnx.string());
  set_parameter(step, "output", output);
  return {model.label, {std::move(step)}};
}

}  // namespace

std::vector<FewPairsModel> few_pairs_models(const std::optional<fs::path>& folder) {
  std::vector<FewPairsModel> found;
  for (const Known& model : known) {
    const std::string name = model.name;
    const fs::path onnx = folder ? *folder / name / "model.onnx" : library_folder("reproduction") / (name + ".onnx");
    if (fs::exists(onnx)) found.push_back({name, model.label, model.pairs, onnx, sha256_of_file(onnx)});
  }
  return found;
}

FilterChain probability_of(const FewPairsModel& model) { return unet_of(model, "probability"); }
FilterChain mask_of(const FewPairsModel& model) { return unet_of(model, "mask"); }

}  // namespace ensonify
