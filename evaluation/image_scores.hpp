#pragma once

#include "ensonify/core/image2.hpp"

/// How like the clean twin a filtered image is. Levels 0..255, both images of the same size.
namespace ensonify {

/// 10 log10(255^2 / mean squared difference), dB; infinite where there is none.
double psnr_db(const Image2<float>& image, const Image2<float>& clean);

/// Mean structural similarity, Wang, Bovik, Sheikh, Simoncelli 2004: Gaussian window of 11 pixels and sigma 1.5,
/// K1 = 0.01, K2 = 0.03, L = 255; without the 5 pixels along the border, whose windows are not whole. NaN below 11
/// x 11.
double ssim(const Image2<float>& image, const Image2<float>& clean);

/// Edge preservation, Sattar, Floreby, Salomonsson, Lovstrom 1997: correlation of the Laplacians of both images, 1
/// where all edges are kept. NaN where one has no edge.
double edge_preservation(const Image2<float>& image, const Image2<float>& clean);

/// Equivalent number of looks (m / s)^2 of the ratio image / clean, which holds speckle and no scene: median over the
/// 16 x 16 tiles where the clean twin is nowhere below 20. Of amplitudes: fully developed speckle of one look has 3.66.
/// NaN without such a tile.
double equivalent_looks(const Image2<float>& image, const Image2<float>& clean);

}  // namespace ensonify
