#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ensonify/core/random.hpp"

namespace ensonify {

/// A value and its 95 % confidence interval over frames. Frames of a trajectory resemble their neighbours, so that the
/// true interval is wider: it tells frames apart, not places.
struct Estimate {
  double value = 0, low = 0, high = 0;
  int frames = 0;  ///< that had a value
};

/// Mean of the finite values, and Student's interval. NaN of none; no interval (NaN) of one.
Estimate mean_estimate(std::span<const double> values);

/// statistic(weights): a figure of pooled frames, a frame counted as often as its weight says. Interval: percentile
/// bootstrap (Efron and Tibshirani 1993, ch. 13) of 1000 resamples of the frames, drawn under `key`.
Estimate bootstrap_estimate(int frames, RandomKey key,
                            const std::function<double(std::span<const int> weights)>& statistic);

}  // namespace ensonify
