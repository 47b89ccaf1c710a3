#pragma once

#include <string>
#include <vector>

#include "ensonify/evaluation/map_report.hpp"

namespace ensonify {

/// Null where the report has none.
const MapCurve* curve_of(const MapReport& report, const std::string& scene, const std::string& filter,
                         const std::string& model, const std::string& poses);

/// The threshold with the greatest balanced accuracy, as an index; the lowest of equals.
std::size_t best_balanced(const MapCurve& curve);
double best_balanced_accuracy(const MapCurve& curve);

/// "0 to 4, 7, 9 to 12" of ascending numbers.
std::string ranges_of(const std::vector<int>& numbers);

}  // namespace ensonify
