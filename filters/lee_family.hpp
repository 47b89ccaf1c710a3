#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

/// Despecklers that weigh a pixel against the mean m of its window by the window's coefficient of variation Ci = s / m.
/// `cu` is the coefficient of variation of fully developed speckle: 0.5227 for amplitude (Rayleigh), 1 / sqrt(looks)
/// for intensity. Cost does not depend on the window. Where m = 0, so is the result.
namespace ensonify {

/// out = m + W (I - m), W = 1 - cu^2 / Ci^2, at least 0.
struct Lee {
  static constexpr const char* name = "lee";
  static constexpr const char* source = "Lee 1980, in the form of OTB, PCI and ESRI";
  static constexpr FilterRole role = FilterRole::despeckles;
  FilterVariant variant = FilterVariant::published;
  WindowSize window;
  double cu = 0.25;
  static constexpr auto parameters() {
    return std::array{variant_parameter<Lee>(), window_parameter<Lee>(),
                      FilterParameter<Lee>{"cu", &Lee::cu, "coefficient of variation of the speckle", {1e-6, 10}}};
  }
};

/// As Lee, W = (1 - cu^2 / Ci^2) / (1 + cu^2).
struct Kuan {
  static constexpr const char* name = "kuan";
  static constexpr const char* source = "Kuan, Sawchuk, Strand, Chavel 1985";
  static constexpr FilterRole role = FilterRole::despeckles;
  FilterVariant variant = FilterVariant::published;
  WindowSize window;
  double cu = 0.25;
  static constexpr auto parameters() {
    return std::array{variant_parameter<Kuan>(), window_parameter<Kuan>(),
                      FilterParameter<Kuan>{"cu", &Kuan::cu, "coefficient of variation of the speckle", {1e-6, 10}}};
  }
};

/// m where Ci <= cu, I where Ci >= cmax, between them m W + I (1 - W), W = exp(-k (Ci - cu) / (cmax - Ci)).
struct LeeEnhanced {
  static constexpr const char* name = "lee_enhanced";
  static constexpr const char* source = "Lopes, Touzi, Nezry 1990; parameters of Lin et al. 2023";
  static constexpr FilterRole role = FilterRole::despeckles;
  FilterVariant variant = FilterVariant::published;
  WindowSize window;
  double k = 1.0, cu = 0.25, cmax = 1.73;
  static constexpr auto parameters() {
    using P = FilterParameter<LeeEnhanced>;
    return std::array{variant_parameter<LeeEnhanced>(), window_parameter<LeeEnhanced>(),
                      P{"k", &LeeEnhanced::k, "damping", {0, 1000}},
                      P{"cu", &LeeEnhanced::cu, "coefficient of variation of the speckle", {1e-6, 10}},
                      P{"cmax", &LeeEnhanced::cmax, "from this Ci on a pixel stays; above cu", {1e-6, 100}}};
  }
};

/// Maximum a posteriori under gamma distributed scene and speckle: m where Ci <= cu, I where Ci >= cmax, between them
/// (b m + sqrt(m^2 b^2 + 4 a L m I)) / (2 a) with a = (1 + cu^2) / (Ci^2 - cu^2), b = a - L - 1.
struct GammaMap {
  static constexpr const char* name = "gamma_map";
  static constexpr const char* source = "Lopes, Nezry, Touzi, Laur 1993";
  static constexpr FilterRole role = FilterRole::despeckles;
  WindowSize window;
  double cu = 0.25;
  std::optional<double> looks, cmax;
  static constexpr auto parameters() {
    using P = FilterParameter<GammaMap>;
    return std::array{
        window_parameter<GammaMap>(), P{"cu", &GammaMap::cu, "coefficient of variation of the speckle", {1e-6, 10}},
        P{"looks", &GammaMap::looks, "L, looks of the speckle", {1e-3, 1e12}, "", "1 / cu^2"},
        P{"cmax", &GammaMap::cmax, "from this Ci on a pixel stays; above cu", {1e-6, 100}, "", "sqrt(2) cu"}};
  }
};

Image2<float> apply(const Lee& method, const GreyImage& image);
Image2<float> apply(const Kuan& method, const GreyImage& image);
Image2<float> apply(const LeeEnhanced& method, const GreyImage& image);
Image2<float> apply(const GammaMap& method, const GreyImage& image);

}  // namespace ensonify
