#pragma once

#include <string>
#include <vector>

#include "ensonify/generators/acceptance_bands.hpp"
#include "ensonify/generators/against.hpp"

namespace ensonify {

/// The schema of docs/datasets.md, "Against real images"; no path of any machine, no time.
std::string against_json(const SideFigures& simulated, const SideFigures& real,
                         const std::vector<AcceptanceBand>& bands);

}  // namespace ensonify
