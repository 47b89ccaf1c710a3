#include "ensonify/noise/scatter_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ensonify/noise/gamma_quantile.hpp"
#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

bool is_dark(std::span<const float> row) {
  int lit = 0;
  for (const float p : row) lit |= static_cast<int>(p != 0.0f);
  return lit == 0;
}

/// Gamma shape of the incoherent stages: looks, or the texture of K.
std::optional<GammaQuantile> gamma_factor(const NoiseChain& chain) {
  if (const auto* gamma = chain.find<GammaSpeckle>()) return GammaQuantile(gamma->looks);
  if (const auto* k = chain.find<KSpeckle>()) return GammaQuantile(k->nu);
  return std::nullopt;
}

}  // namespace

void add_gaussian(std::span<const float> power, std::span<float> uniform0, std::span<float> uniform1,
                  std::span<float> real, std::span<float> imaginary) {
  to_normal(uniform0);
  to_normal(uniform1);
  for (std::size_t b = 0; b < power.size(); ++b) {
    const float scale = std::sqrt(0.5f * power[b]);
    real[b] += scale * uniform0[b];
    imaginary[b] += scale * uniform1[b];
  }
}

void add_scatterers(const Echo& layers, SurfaceCells& cells, RandomKey surface, ComplexField& field) {
  constexpr std::size_t chunk = 32;  // of beams: most of an image is dark
  std::array<float, chunk> uniform0, uniform1;
  const auto beams = static_cast<std::size_t>(layers.direct.columns());
  const auto add_layer = [&](const Image2<float>& layer, RandomKey key) {
    for (int bin = 0; bin < layer.rows(); ++bin) {
      for (std::size_t first = 0; first < beams; first += chunk) {
        const std::size_t count = std::min(chunk, beams - first);
        const auto power = layer.row(bin).subspan(first, count);
        if (is_dark(power)) continue;
        const auto elevation = layers.elevation_rad.empty() ? std::span<const float>{}
                                                            : layers.elevation_rad.row(bin).subspan(first, count);
        const auto numbers0 = std::span(uniform0).first(count);
        const auto numbers1 = std::span(uniform1).first(count);
        cells.resolution_cells(key, bin, first, elevation, numbers0, numbers1);
        add_gaussian(power, numbers0, numbers1, field.real.row(bin).subspan(first, count),
                     field.imaginary.row(bin).subspan(first, count));
      }
    }
  };
  add_layer(layers.direct, surface.child("direct"));
  if (!layers.multipath.empty()) add_layer(layers.multipath, surface.child("multipath"));
}

ComplexField incoherent_field(const NoiseChain& chain, const Image2<float>& intensity, RandomKey ping) {
  ComplexField field(intensity.rows(), intensity.columns());
  const bool exponential = chain.find<RayleighSpeckle>() != nullptr || chain.find<KSpeckle>() != nullptr;
  const std::optional<GammaQuantile> gamma = gamma_factor(chain);
  const auto beams = static_cast<std::size_t>(intensity.columns());
  std::vector<float> power(beams), factor(beams), direction(2 * beams);
  for (int bin = 0; bin < intensity.rows(); ++bin) {
    const auto row = static_cast<std::uint32_t>(bin);
    std::copy(intensity.row(bin).begin(), intensity.row(bin).end(), power.begin());
    if (is_dark(power)) continue;
    if (exponential) {
      uniform_row(ping.child("exponential"), row, factor);
      to_rayleigh(factor);
      for (std::size_t b = 0; b < beams; ++b) power[b] *= 0.5f * factor[b] * factor[b];
    }
    if (gamma) {
      uniform_row(ping.child("gamma"), row, factor);
      gamma->apply(factor);
      for (std::size_t b = 0; b < beams; ++b) power[b] *= factor[b];
    }
    // The direction of a circular Gaussian number is uniform.
    uniform_row(ping.child("phase"), row, direction);
    to_normal(direction);
    const auto re = field.real.row(bin);
    const auto im = field.imaginary.row(bin);
    for (std::size_t b = 0; b < beams; ++b) {
      const float x = direction[b];
      const float y = direction[beams + b];
      const float scale = std::sqrt(power[b] / std::max(x * x + y * y, 1e-30f));
      re[b] = scale * x;
      im[b] = scale * y;
    }
  }
  return field;
}

}  // namespace ensonify
