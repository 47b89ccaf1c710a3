#include "ensonify/noise/noise_chain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

constexpr Limits sigma_limits{0.0, 10.0};
constexpr std::size_t max_stages = 32;

NoiseStage<Distribution> read_stage(Reader& stage) {
  const std::string kind = stage.choice("stage", {GaussianSpeckle<double>::kind, AdditiveRayleigh<double>::kind});
  const Distribution sigma = read_distribution(stage, "sigma", sigma_limits);
  if (kind == GaussianSpeckle<double>::kind) return GaussianSpeckle<Distribution>{sigma};
  return AdditiveRayleigh<Distribution>{sigma};
}

/// Names every stage by its kind and which of its kind it is, so that other stages do not shift its numbers.
template <typename Value>
std::vector<std::string> stage_names(const std::vector<NoiseStage<Value>>& stages) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const auto same = std::count_if(stages.begin(), stages.begin() + static_cast<std::ptrdiff_t>(i),
                                    [&](const auto& s) { return s.index() == stages[i].index(); });
    const std::string kind = std::visit([](const auto& s) { return std::string(s.kind); }, stages[i]);
    names.push_back(same == 0 ? kind : fmt::format("{}_{}", kind, same + 1));
  }
  return names;
}

/// A row of the image and the uniform numbers at its pixels.
struct RowDisturbance {
  std::span<float> level;
  std::span<float> uniform;

  void operator()(const GaussianSpeckle<double>& stage) const {
    to_normal(uniform);
    const auto sigma = static_cast<float>(stage.sigma);
    for (std::size_t b = 0; b < level.size(); ++b) level[b] *= 1.0f + sigma * uniform[b];
  }
  void operator()(const AdditiveRayleigh<double>& stage) const {
    to_rayleigh(uniform);
    const auto sigma = static_cast<float>(stage.sigma);
    for (std::size_t b = 0; b < level.size(); ++b) level[b] += sigma * uniform[b];
  }
};

}  // namespace

NoiseProfile load_noise(const std::string& path_or_name) {
  Reader file = Reader::from_file(resolve_name("noise", path_or_name));
  NoiseProfile profile;
  profile.name = file.text("name");
  for (Reader& stage : file.children("stages")) {
    profile.stages.push_back(read_stage(stage));
    stage.finish();
  }
  if (profile.stages.size() > max_stages) file.fail("stages", fmt::format("at most {} stages", max_stages));
  file.finish();
  return profile;
}

NoiseChain sample_noise(const NoiseProfile& profile, RandomKey key, SampledValues& sampled) {
  NoiseChain chain{profile.name, {}};
  const std::vector<std::string> names = stage_names(profile.stages);
  for (std::size_t i = 0; i < profile.stages.size(); ++i) {
    RandomSequence random(key.child(names[i]));
    const auto draw = [&](const char* parameter, const Distribution& distribution) {
      const double value = sample(distribution, random);
      if (!std::holds_alternative<Constant>(distribution)) {
        sampled.emplace_back(fmt::format("noise.{}.{}", names[i], parameter), value);
      }
      return value;
    };
    std::visit([&](const auto& stage) { chain.stages.emplace_back(stage.map(draw)); }, profile.stages[i]);
  }
  return chain;
}

Image2<float> disturb(const NoiseChain& chain, Image2<float> level, RandomKey key) {
  const auto beams = static_cast<std::size_t>(level.columns());
  std::vector<std::uint32_t> words(beams);
  std::vector<float> uniform(beams);
  const std::vector<std::string> names = stage_names(chain.stages);
  for (std::size_t i = 0; i < chain.stages.size(); ++i) {
    const RandomKey stage_key = key.child(names[i]);
    for (int bin = 0; bin < level.rows(); ++bin) {
      fill_words(stage_key, static_cast<std::uint32_t>(bin), words);
      for (std::size_t b = 0; b < beams; ++b) uniform[b] = uniform_of(words[b]);
      std::visit(RowDisturbance{level.row(bin), uniform}, chain.stages[i]);
    }
  }
  for (float& v : level.pixels()) v = std::min(std::max(v, 0.0f), 1.0f);
  return level;
}

}  // namespace ensonify
