#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/output/exr.hpp"

namespace ensonify {

inline constexpr const char* truth_comment =
    "ensonify truth; rows = range bins, columns = beams (port first). direct: received over source intensity at 1 m, "
    "before the point spread. elevation.*, incidence: rad, NaN = nothing echoes here. instance: index, -1 = none.";

/// Channels of truth.exr: direct, and where the truth was asked for elevation.min, elevation.max,
/// elevation.strongest, incidence, instance.
std::vector<Channel> truth_channels(const Echo& echo, const PingTruth& truth);

}  // namespace ensonify
