#pragma once

#include "ensonify/core/grey_image.hpp"
#include "ensonify/filters/filter_parameter.hpp"

namespace ensonify {

/// Anisotropic diffusion on four neighbours, no flux through the border: I += gamma div(c(|d|) d / step), explicit, in
/// 32-bit floats. Conductance c of option 1: exp(-(d / kappa)^2), favours strong edges; 2: 1 / (1 + (d / kappa)^2),
/// favours wide regions; 3: Tukey's biweight (Black et al. 1998). d is the raw difference of neighbours, as in Kovesi's
/// and Muldal's programs: a step of 2 halves the flux along that axis. Keeps the mean.
struct Anisodiff {
  static constexpr const char* name = "anisodiff";
  static constexpr const char* source = "Perona and Malik 1990; scheme of Kovesi; parameters of Lin et al. 2023";
  static constexpr FilterRole role = FilterRole::despeckles;
  int iterations = 2;
  double kappa = 60, gamma = 0.1, step_row = 1, step_col = 2;
  int option = 1;
  static constexpr auto parameters() {
    using P = FilterParameter<Anisodiff>;
    return std::array{
        P{"iterations", &Anisodiff::iterations, "steps of time", {0, 10000}},
        P{"kappa", &Anisodiff::kappa, "difference that counts as an edge", {1e-6, 1e6}, "grey levels"},
        P{"gamma", &Anisodiff::gamma, "length of a step; stable up to 1 / (2 / step_row + 2 / step_col)", {0, 1}},
        P{"step_row", &Anisodiff::step_row, "distance of rows", {1e-3, 1e3}},
        P{"step_col", &Anisodiff::step_col, "distance of columns", {1e-3, 1e3}},
        P{"option", &Anisodiff::option, "conductance: 1 exponential, 2 rational, 3 Tukey", {1, 3}}};
  }
};

/// Speckle reducing anisotropic diffusion of I + 1: conductance 1 / (1 + (q^2 - q0^2) / (q0^2 (1 + q0^2))), held to
/// 0..1, of the instantaneous coefficient of variation q (their eq. 31 to 37); q0 falls as exp(-rho t).
struct Srad {
  static constexpr const char* name = "srad";
  static constexpr const char* source = "Yu and Acton 2002";
  static constexpr FilterRole role = FilterRole::despeckles;
  int iterations = 10;
  double dt = 0.05, rho = 1.0 / 6.0;
  std::optional<double> q0;
  static constexpr auto parameters() {
    using P = FilterParameter<Srad>;
    return std::array{P{"iterations", &Srad::iterations, "steps of time", {0, 10000}},
                      P{"dt", &Srad::dt, "length of a step", {0, 1}},
                      P{"rho", &Srad::rho, "how fast q0 falls", {0, 100}},
                      P{"q0",
                        &Srad::q0,
                        "coefficient of variation of the speckle at the start",
                        {1e-6, 100},
                        "",
                        "s / m of the whole image"}};
  }
};

/// Throws ConfigError where the step of time is unstable.
void check(const Anisodiff& method);

Image2<float> apply(const Anisodiff& method, const GreyImage& image);
Image2<float> apply(const Srad& method, const GreyImage& image);

}  // namespace ensonify
