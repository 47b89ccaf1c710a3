#pragma once

#include "ensonify/core/complex_field.hpp"
#include "ensonify/core/echo.hpp"
#include "ensonify/noise/noise_chain.hpp"
#include "ensonify/noise/ping_setting.hpp"
#include "ensonify/noise/surface_cells.hpp"

namespace ensonify {

/// Adds circular complex Gaussian numbers of mean power `power` to a row.
void add_gaussian(std::span<const float> power, std::span<float> uniform0, std::span<float> uniform1,
                  std::span<float> real, std::span<float> imaginary);

/// The echo's layers as independent scatterers fixed to the surface, before pulse and array: adds to `field`, each
/// layer with numbers of its own.
void add_scatterers(const Echo& layers, SurfaceCells& cells, RandomKey surface, ComplexField& field);

/// A field whose intensity is `intensity` times the chain's incoherent speckle (none: 1), with random phases; numbers
/// are new in every ping.
ComplexField incoherent_field(const NoiseChain& chain, const Image2<float>& intensity, RandomKey ping);

}  // namespace ensonify
