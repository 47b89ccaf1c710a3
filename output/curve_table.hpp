#pragma once

#include "ensonify/output/plot.hpp"
#include "ensonify/output/report_table.hpp"

namespace ensonify {

/// The curves of a plot as numbers: a line an x, in ascending order, and a column a series. Digits after the point.
ReportTable curve_table(const Plot& plot, int x_digits, int y_digits);

}  // namespace ensonify
