#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/evaluation/map_report.hpp"

namespace ensonify {

/// What one line says of a curve, by name: the best threshold (greatest F1 of the last tolerance), scores there, FNR at
/// equal FPR, and loss_*: score with true poses minus this one's, both at the threshold that is best with true poses
/// (NaN for the true poses themselves, and where they were not run). The same names for every curve of a report.
std::vector<std::pair<std::string, double>> summary_of(const MapReport& report, const MapCurve& curve);

}  // namespace ensonify
