#pragma once

#include <array>
#include <span>

namespace ensonify {

/// Gamma distributed numbers of mean 1 by inversion, from a table over the normal quantile: between its points the cube
/// root of a gamma number is nearly linear there (Wilson and Hilferty 1931).
class GammaQuantile {
 public:
  /// shape in [0.1, 1000].
  explicit GammaQuantile(double shape);

  /// uniform in (0, 1) -> Gamma(shape) / shape, in place.
  void apply(std::span<float> uniforms) const;

 private:
  static constexpr int steps = 256;
  static constexpr float reach = 6.0f;  ///< normal quantiles of 23-bit uniforms stay below 5.3
  std::array<float, steps + 2> cube_root_;
};

}  // namespace ensonify
