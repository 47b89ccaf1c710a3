#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/frost.hpp"
#include "ensonify/filters/lee_family.hpp"

/// The despecklers of PyRadar (PyRadar/pyradar, 2012), as its port in findpeaks computes them and Lin et al. 2023 most
/// likely used them, for comparison with that paper. What differs from the publications: docs/filters.md.
namespace ensonify {

/// lee (factor 1) and kuan (factor 1 / (1 + cu^2)); results rounded half to even; 0 where the window's mean is 0.
Image2<float> pyradar_lee(const Image2<float>& grey, int window, double cu, double factor);
Image2<float> pyradar_lee_enhanced(const Image2<float>& grey, const LeeEnhanced& method);
/// Weights by difference of grey level, not by distance; 8-bit images stay whole numbers, cut not rounded.
Image2<float> pyradar_frost(const GreyImage& image, const Frost& method);

}  // namespace ensonify
