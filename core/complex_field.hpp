#pragma once

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Complex pressure amplitude a pixel, rows = range bins, columns = beams; |field|^2 is intensity in units of `Echo`.
struct ComplexField {
  ComplexField(int rows, int columns) : real(rows, columns), imaginary(rows, columns) {}

  Image2<float> real, imaginary;
};

}  // namespace ensonify
