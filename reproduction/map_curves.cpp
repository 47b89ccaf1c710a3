#include "ensonify/reproduction/map_curves.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace ensonify {

const MapCurve* curve_of(const MapReport& report, const std::string& scene, const std::string& filter,
                         const std::string& model, const std::string& poses) {
  const auto found = std::ranges::find_if(report.curves, [&](const MapCurve& c) {
    return c.scene == scene && c.filter == filter && c.model == model && c.poses == poses;
  });
  return found == report.curves.end() ? nullptr : &*found;
}

std::size_t best_balanced(const MapCurve& curve) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    const double value = curve.at[i].balanced_accuracy();
    if (!(value > most)) continue;
    most = value;
    best = i;
  }
  return best;
}

double best_balanced_accuracy(const MapCurve& curve) { return curve.at.at(best_balanced(curve)).balanced_accuracy(); }

std::string ranges_of(const std::vector<int>& numbers) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    words.push_back(end == i ? fmt::format("{}", numbers[i]) : fmt::format("{} to {}", numbers[i], numbers[end]));
    i = end + 1;
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace ensonify
