#pragma once

#include <span>
#include <variant>
#include <vector>

namespace ensonify {

struct Relu {};
struct LeakyRelu {
  float slope = 0.01F;  ///< of negative numbers
};
struct Sigmoid {};

/// What a network does to each number by itself.
using Activation = std::variant<Relu, LeakyRelu, Sigmoid>;

/// Each of them in turn, in place. Sigmoid is right to 3e-7.
void activate(const std::vector<Activation>& activations, std::span<float> numbers);

}  // namespace ensonify
