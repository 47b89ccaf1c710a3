#pragma once

#include "ensonify/generators/against.hpp"
#include "ensonify/output/contact_sheet.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// One sheet, a curve a side: speckle and its Weibull laws, autocorrelations, levels, profiles, ping to ping.
PlotSheet against_plots(const SideFigures& simulated, const SideFigures& real);

/// Side by side: an image of each side, the middle one of those read, each once more with its even tiles framed.
ContactSheet against_pictures(const PingSeries& simulated, const SideFigures& simulated_figures, const PingSeries& real,
                              const SideFigures& real_figures);

}  // namespace ensonify
