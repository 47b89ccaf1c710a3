#pragma once

#include <map>
#include <string>
#include <vector>

#include "ensonify/config/library.hpp"
#include "ensonify/filters/filter_method.hpp"

namespace ensonify {

/// Steps one after the other.
struct FilterChain {
  std::string name;
  std::vector<FilterStep> steps;
};

/// Applies the steps. The result is on the scale 0..255, not rounded; a detector's is a mask of 0 and 255. Empty images
/// stay empty. Throws DataError where a pixel is not finite.
GreyImage apply(const FilterChain& chain, const GreyImage& raw);

/// One step; `raw` is what the chain began with.
GreyImage apply(const FilterStep& step, const GreyImage& image, const GreyImage& raw);

/// Loads a chain (keys `name`, `steps`, each step `method` and its parameters). Throws ConfigError.
FilterChain load_filter_chain(const ConfigSource& source);

/// What a command line names: a method with its defaults, else a chain's file or bundled name. Throws ConfigError.
FilterChain find_filter(const std::string& method_or_chain);

/// The same, or no step at all for "none".
FilterChain find_filter_or_none(const std::string& name);

/// The chain that Lin et al. 2023 put before their mapper: the filter (no steps: the raw image); where it ends in a
/// mask, that mask applied to the raw image; and, where `post_process`, the unsharp filter, unless the chain has it
/// already, and histogram equalisation.
FilterChain chain_for_maps(FilterChain filter, bool post_process);

/// Chosen parameters for methods (path or bundled name; the key `methods` holds a mapping a method).
struct FilterPreset {
  std::string name, about;
  std::map<std::string, FilterStep> methods;
};
FilterPreset load_filter_preset(const std::string& path_or_name);

}  // namespace ensonify
