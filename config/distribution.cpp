#include "ensonify/config/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {
namespace {

struct Sampler {
  RandomSequence& random;
  double operator()(const Constant& d) const { return d.value; }
  double operator()(const Uniform& d) const { return random.uniform(d.low, d.high); }
  double operator()(const LogUniform& d) const {
    return std::clamp(std::exp(random.uniform(std::log(d.low), std::log(d.high))), d.low, d.high);
  }
  double operator()(const Normal& d) const { return d.mean + d.sigma * std::clamp(random.normal(), -3.0, 3.0); }
  double operator()(const Choice& d) const {
    return d.values[static_cast<std::size_t>(random.below(static_cast<int>(d.values.size())))];
  }
};

struct Ends {
  Limits operator()(const Constant& d) const { return {d.value, d.value}; }
  Limits operator()(const Uniform& d) const { return {d.low, d.high}; }
  Limits operator()(const LogUniform& d) const { return {d.low, d.high}; }
  Limits operator()(const Normal& d) const { return {d.mean - 3.0 * d.sigma, d.mean + 3.0 * d.sigma}; }
  Limits operator()(const Choice& d) const {
    const auto [low, high] = std::minmax_element(d.values.begin(), d.values.end());
    return {*low, *high};
  }
};

}  // namespace

Distribution read_distribution(Reader& reader, std::string_view key, Limits limits) {
  if (!reader.node(key).IsMap()) return Constant{reader.number(key, limits)};
  Reader spec = reader.child(key);
  const auto interval = [&](std::string_view name) {
    const std::vector<double> ends = spec.numbers(name, 2, limits);
    if (ends[0] > ends[1]) spec.fail(name, "the first number must not exceed the second");
    return ends;
  };
  Distribution result;
  if (spec.has("uniform")) {
    const auto ends = interval("uniform");
    result = Uniform{ends[0], ends[1]};
  } else if (spec.has("log_uniform")) {
    const auto ends = interval("log_uniform");
    if (ends[0] <= 0) spec.fail("log_uniform", "both ends must be above 0");
    result = LogUniform{ends[0], ends[1]};
  } else if (spec.has("normal")) {
    const std::vector<double> v = spec.numbers("normal", 2);
    if (v[1] < 0) spec.fail("normal", "sigma must not be negative");
    if (v[0] - 3 * v[1] < limits.low || v[0] + 3 * v[1] > limits.high) {
      spec.fail("normal", "mean +- 3 sigma leaves the allowed interval of this parameter");
    }
    result = Normal{v[0], v[1]};
  } else if (spec.has("choice")) {
    result = Choice{spec.numbers("choice", -1, limits)};
    if (std::get<Choice>(result).values.empty()) spec.fail("choice", "needs at least one value");
  } else {
    spec.finish();
    reader.fail(key, "must be a number, or one of uniform, log_uniform, normal, choice");
  }
  spec.finish();
  return result;
}

Distribution read_distribution_or(Reader& reader, std::string_view key, double fallback, Limits limits) {
  return reader.has(key) ? read_distribution(reader, key, limits) : Distribution{Constant{fallback}};
}

double sample(const Distribution& distribution, RandomSequence& random) {
  return std::visit(Sampler{random}, distribution);
}

Limits ends_of(const Distribution& distribution) { return std::visit(Ends{}, distribution); }

}  // namespace ensonify
