#pragma once

#include "ensonify/generators/form_images.hpp"
#include "ensonify/output/exr.hpp"

namespace ensonify {

inline constexpr const char* truth_comment =
    "ensonify truth; rows = range bins, columns = beams (port first). direct, multipath: received over source "
    "intensity at "
    "1 m, before the point spread; sidelobe: the same through sidelobes and leaks, after it. elevation.*, incidence: "
    "rad, "
    "NaN = nothing echoes here. instance: index, -1 = none.";

/// Channels of truth.exr: direct, multipath and sidelobe (zero where the noise models none), and where the truth was
/// asked for elevation.min, elevation.max, elevation.strongest, incidence, instance.
std::vector<Channel> truth_channels(const Echo& echo, const PingImages& images, const PingTruth& truth);

}  // namespace ensonify
