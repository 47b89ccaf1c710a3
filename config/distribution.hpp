#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "ensonify/config/reader.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {

struct Constant {
  double value = 0;
};
struct Uniform {
  double low = 0, high = 0;
};
/// Uniform in the logarithm; both ends above 0.
struct LogUniform {
  double low = 1, high = 1;
};
/// Normal, cut at +-3 sigma by clamping.
struct Normal {
  double mean = 0, sigma = 0;
};
struct Choice {
  std::vector<double> values;
};

/// What a recipe may write wherever a number stands: a plain number, or
/// `{uniform: [a, b]}`, `{log_uniform: [a, b]}`, `{normal: [mean, sigma]}`, `{choice: [a, b, ...]}`.
using Distribution = std::variant<Constant, Uniform, LogUniform, Normal, Choice>;

/// Reads one; every value it can give must keep the limits. Throws ConfigError.
Distribution read_distribution(Reader& reader, std::string_view key, Limits limits = any_number);
Distribution read_distribution_or(Reader& reader, std::string_view key, double fallback, Limits limits = any_number);

double sample(const Distribution& distribution, RandomSequence& random);

/// The least and the largest value that it can give.
Limits ends_of(const Distribution& distribution);

}  // namespace ensonify
