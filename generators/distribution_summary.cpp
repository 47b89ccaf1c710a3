#include "ensonify/generators/distribution_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ensonify {

Histogram histogram(std::span<const double> values, double low, double high, int bins) {
  Histogram result{low, high, std::vector<std::uint64_t>(static_cast<std::size_t>(bins))};
  const double width = high - low;
  for (const double v : values) {
    const int bin = width > 0 ? static_cast<int>(std::clamp((v - low) / width, 0.0, 1.0) * bins) : 0;
    ++result.counts[static_cast<std::size_t>(std::min(bin, bins - 1))];
  }
  return result;
}

Summary summarise(std::span<const double> values, double low, double high, int bins) {
  Summary summary;
  summary.histogram = histogram(values, low, high, bins);
  summary.count = values.size();
  if (values.empty()) return summary;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  summary.min = *min;
  summary.max = *max;
  summary.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return summary;
}

double percentile(std::span<const double> sorted, double percent) {
  if (sorted.empty()) return 0;
  const double at = percent / 100.0 * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace ensonify
