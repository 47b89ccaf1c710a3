#pragma once

#include <array>
#include <string>

namespace ensonify {

/// Acoustic surface. Backscatter per unit area at incidence angle i (monostatic):
///   sigma(i) = mu cos^2(i) + s cos^n(i),   mu = 10^(lambert_db / 10), s = 10^(specular_db / 10), n = specular_exponent
/// Lambert's law (Urick 1983, 8.4) plus a specular lobe. Shadowing is complete: nothing transmits.
struct Material {
  std::string name;
  double lambert_db = -20;
  double specular_db = -60;
  double specular_exponent = 50;                  ///< at least 2
  std::string source;                             ///< where the numbers come from, or "assumed"
  std::array<float, 3> colour{0.6f, 0.6f, 0.6f};  ///< sRGB 0..1, for pictures only
};

/// sigma(i) for cos_incidence in [0, 1].
double backscatter(const Material& material, double cos_incidence);

}  // namespace ensonify
