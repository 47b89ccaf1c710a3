#pragma once

#include <string>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/generators/split_frames.hpp"

namespace ensonify {

/// Which image of a dataset a map begins with.
enum class MapSource {
  raw,        ///< what the instrument gives
  clean,      ///< its noise-free twin: the upper bound of every filter
  truth_mask  ///< the raw image where the true mask is set, 0 elsewhere: the upper bound of every mask
};

/// From the images of a frame to the one that a mapper takes.
struct MapFilter {
  std::string name;
  MapSource source = MapSource::raw;
  FilterChain chain;  ///< what follows: the filter, its mask applied, unsharp filter and equalisation
};

/// "none" (or "raw"), "clean", "truth_mask", a method, a chain's file or bundled name; a method's parameters as in the
/// preset of that name or file, where it has them ("" for the defaults). `post_process` adds the unsharp filter and the
/// histogram equalisation of Lin et al. (ICRA 2023). Throws ConfigError.
MapFilter find_map_filter(const std::string& name, const std::string& preset, bool post_process);

/// Grey levels rounded to whole ones: thresholds are of 8 bits.
Image2<std::uint8_t> image_for_map(const MapFilter& filter, const JudgedFrame& frame);

}  // namespace ensonify
