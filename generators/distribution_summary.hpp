#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ensonify {

/// Counts of values in equal steps from low to high; a value at high counts in the last.
struct Histogram {
  double low = 0, high = 0;
  std::vector<std::uint64_t> counts;
};

Histogram histogram(std::span<const double> values, double low, double high, int bins);

struct Summary {
  std::uint64_t count = 0;
  double min = 0, mean = 0, max = 0;
  Histogram histogram;
};

/// `low`, `high`: edges of the histogram, common to what is to be compared. Of no values: zeros.
Summary summarise(std::span<const double> values, double low, double high, int bins);

/// The value below which `percent` of the values lie, between neighbours by a straight line (numpy.percentile's
/// default). `sorted` must be ascending; 0 of no values.
double percentile(std::span<const double> sorted, double percent);

}  // namespace ensonify
