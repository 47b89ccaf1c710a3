#include "ensonify/scenes/material.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {

double backscatter(const Material& material, double cos_incidence) {
  const double c = std::clamp(cos_incidence, 0.0, 1.0);
  const double mu = std::pow(10.0, material.lambert_db / 10.0);
  const double specular = std::pow(10.0, material.specular_db / 10.0);
  return mu * c * c + specular * std::pow(c, material.specular_exponent);
}

}  // namespace ensonify
