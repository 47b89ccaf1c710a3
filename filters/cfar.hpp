#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

namespace ensonify {

/// Constant false alarm rate detection along range: 255 where the intensity x = grey^exponent exceeds factor times the
/// background that `train` cells before and after, `guard` cells away, tell: their mean (ca), the smaller or larger of
/// the two means (soca, goca), or the cell of order rank * N (os). The factor gives `pfa` in exponentially distributed
/// intensity, that is fully developed speckle; at the ends of the range, with the cells that are there.
struct Cfar {
  static constexpr const char* name = "cfar";
  static constexpr const char* source = "Finn and Johnson 1968; Rohling 1983; Gandhi and Kassam 1988";
  static constexpr FilterRole role = FilterRole::detects;
  CfarRule rule = CfarRule::soca;
  int train = 20, guard = 5;
  double pfa = 1e-3, rank = 0.75, exponent = 2.0;
  static constexpr auto parameters() {
    using P = FilterParameter<Cfar>;
    return std::array{P{"rule", &Cfar::rule, "how the cells give the background"},
                      P{"train", &Cfar::train, "cells on each side", {1, 1000}, "bins"},
                      P{"guard", &Cfar::guard, "cells left out on each side", {0, 1000}, "bins"},
                      P{"pfa", &Cfar::pfa, "probability of false alarm", {1e-12, 0.5}},
                      P{"rank", &Cfar::rank, "of rule os: share of the cells below", {0.01, 1}},
                      P{"exponent", &Cfar::exponent, "intensity = grey^exponent; 2 for amplitude images", {0.1, 10}}};
  }
};

Image2<float> apply(const Cfar& method, const GreyImage& image);

/// Factor on the background of `before` and `after` cells for that probability of false alarm; either may be 0, not
/// both.
double cfar_factor(CfarRule rule, int before, int after, double pfa, double rank);

}  // namespace ensonify
