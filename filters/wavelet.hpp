#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

namespace ensonify {

/// Soft threshold of Haar coefficients on max(floor(log2(shortest side)) - 3, 1) levels, approximation untouched.
/// Rule visu (VisuShrink): one T = sigma sqrt(2 ln(pixels)), sigma from the diagonal band of Daubechies' db2 wavelet.
/// Rule bayes (BayesShrink, Chang, Yu, Vetterli 2000): T = sigma^2 / sqrt(max(E[d^2] - sigma^2, eps)) a band, sigma
/// from the finest diagonal Haar band. sigma = median |d| / 0.6745, zeros left out. As scikit-image's denoise_wavelet
/// has it; images of whole grey levels are held to 0..255 as there.
struct Wavelet {
  static constexpr const char* name = "wavelet";
  static constexpr const char* source = "Donoho and Johnstone 1994; parameters of Lin et al. 2023";
  static constexpr FilterRole role = FilterRole::despeckles;
  WaveletRule rule = WaveletRule::visu;
  std::optional<double> sigma_scale, sigma;
  static constexpr auto parameters() {
    using P = FilterParameter<Wavelet>;
    return std::array{
        P{"rule", &Wavelet::rule, "VisuShrink or BayesShrink"},
        P{"sigma_scale", &Wavelet::sigma_scale, "factor on the estimated sigma", {0, 100}, "", "visu 0.25, bayes 1"},
        P{"sigma", &Wavelet::sigma, "noise level", {0, 1e6}, "grey levels", "estimated"}};
  }
};

Image2<float> apply(const Wavelet& method, const GreyImage& image);

}  // namespace ensonify
