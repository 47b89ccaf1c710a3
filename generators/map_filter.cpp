#include "ensonify/generators/map_filter.hpp"

#include <algorithm>
#include <cmath>

#include "ensonify/filters/filter_registry.hpp"

namespace ensonify {
namespace {

FilterChain chain_named(const std::string& name, const std::string& preset) {
  FilterChain chain = find_filter(name);
  const bool method = chain.steps.size() == 1 && chain.name == name_of(chain.steps[0].method);
  if (preset.empty() || !method) return chain;
  const FilterPreset chosen = load_filter_preset(preset);
  if (const auto found = chosen.methods.find(chain.name); found != chosen.methods.end()) {
    chain.steps[0] = found->second;
  }
  return chain;
}

}  // namespace

MapFilter find_map_filter(const std::string& name, const std::string& preset, bool post_process) {
  MapFilter filter{name, MapSource::raw, {name, {}}};
  if (name == "clean") {
    filter.source = MapSource::clean;
  } else if (name == "truth_mask") {
    filter.source = MapSource::truth_mask;
  } else if (name == "none" || name == "raw") {
    filter.name = "raw";
  } else {
    filter.chain = chain_named(name, preset);
    filter.name = filter.chain.name;
  }
  filter.chain = chain_for_maps(std::move(filter.chain), post_process);
  return filter;
}

Image2<std::uint8_t> image_for_map(const MapFilter& filter, const JudgedFrame& frame) {
  GreyImage image = frame.raw;
  if (filter.source == MapSource::clean) image = {frame.clean, GreyDepth::bits8};
  if (filter.source == MapSource::truth_mask) {
    for (std::size_t i = 0; i < image.grey.size(); ++i) {
      if (frame.mask.pixels()[i] == 0) image.grey.pixels()[i] = 0;
    }
  }
  if (!filter.chain.steps.empty()) image = apply(filter.chain, image);
  Image2<std::uint8_t> grey(image.grey.rows(), image.grey.columns());
  std::ranges::transform(image.grey.pixels(), grey.pixels().begin(), [](float level) {
    return static_cast<std::uint8_t>(std::lrint(std::clamp(level, 0.0F, 255.0F)));
  });
  return grey;
}

}  // namespace ensonify
