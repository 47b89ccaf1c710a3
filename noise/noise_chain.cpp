#include "ensonify/noise/noise_chain.hpp"

#include <algorithm>

#include "ensonify/config/library.hpp"
#include "ensonify/config/reader.hpp"
#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

constexpr Limits sigma_limits{0.0, 10.0};

NoiseStage read_stage(Reader& stage) {
  const std::string kind = stage.choice("stage", {"gaussian_speckle", "additive_rayleigh"});
  if (kind == "gaussian_speckle") return GaussianSpeckle{stage.number("sigma", sigma_limits)};
  return AdditiveRayleigh{stage.number("sigma", sigma_limits)};
}

/// Tag of a stage's numbers: its kind and which of its kind it is, so that other stages do not shift them.
std::string tag(const NoiseChain& chain, std::size_t place) {
  const std::size_t kind = chain.stages[place].index();
  static constexpr std::array names{"gaussian_speckle", "additive_rayleigh"};
  const auto same = std::count_if(chain.stages.begin(), chain.stages.begin() + static_cast<std::ptrdiff_t>(place),
                                  [&](const NoiseStage& s) { return s.index() == kind; });
  return std::string(names[kind]) + static_cast<char>('0' + same);
}

/// Random numbers and the row they act on.
struct RowDisturbance {
  std::span<float> level;
  std::span<float> uniform;

  void operator()(const GaussianSpeckle& stage) const {
    to_normal(uniform);
    const auto sigma = static_cast<float>(stage.sigma);
    for (std::size_t b = 0; b < level.size(); ++b) level[b] *= 1.0f + sigma * uniform[b];
  }
  void operator()(const AdditiveRayleigh& stage) const {
    to_rayleigh(uniform);
    const auto sigma = static_cast<float>(stage.sigma);
    for (std::size_t b = 0; b < level.size(); ++b) level[b] += sigma * uniform[b];
  }
};

}  // namespace

NoiseChain load_noise(const std::string& path_or_name) {
  Reader file = Reader::from_file(resolve_name("noise", path_or_name));
  NoiseChain chain;
  chain.name = file.text("name");
  for (Reader& stage : file.children("stages")) {
    chain.stages.push_back(read_stage(stage));
    stage.finish();
  }
  if (chain.stages.size() > 10) file.fail("stages", "at most 10 stages");
  file.finish();
  return chain;
}

Image2<float> disturb(const NoiseChain& chain, Image2<float> level, RandomKey key) {
  const auto beams = static_cast<std::size_t>(level.columns());
  std::vector<std::uint32_t> words(beams);
  std::vector<float> uniform(beams);
  for (std::size_t place = 0; place < chain.stages.size(); ++place) {
    const RandomKey stage_key = key.child(tag(chain, place));
    for (int bin = 0; bin < level.rows(); ++bin) {
      fill_words(stage_key, static_cast<std::uint32_t>(bin), words);
      for (std::size_t b = 0; b < beams; ++b) uniform[b] = uniform_of(words[b]);
      std::visit(RowDisturbance{level.row(bin), uniform}, chain.stages[place]);
    }
  }
  for (float& v : level.pixels()) v = std::clamp(v, 0.0f, 1.0f);
  return level;
}

}  // namespace ensonify
