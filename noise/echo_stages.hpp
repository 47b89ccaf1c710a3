#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/noise/ping_setting.hpp"
#include "ensonify/noise/surface_cells.hpp"

namespace ensonify {

/// Runs the stages of a chain that act on the echo: the layers as the chain has them. Without a `multipath` stage there
/// is no multipath; with one it must have been traced (std::logic_error).
Echo disturb_layers(const NoiseChain& chain, const Echo& echo, const SonarGeometry& geometry, SurfaceCells& cells,
                    const PingSetting& setting);

}  // namespace ensonify
