#pragma once

#include "ensonify/evaluation/intervals.hpp"
#include "ensonify/output/plot.hpp"

namespace ensonify {

/// An estimate and its interval as the next point or bar of a series *_with_errors.
inline void add_estimate(Series& series, double x, const Estimate& estimate) {
  series.x.push_back(x);
  series.y.push_back(estimate.value);
  series.y_low.push_back(estimate.low);
  series.y_high.push_back(estimate.high);
}

}  // namespace ensonify
