#include "ensonify/noise/noise_chain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ensonify/config/reader.hpp"
#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

constexpr std::size_t max_stages = 32;
constexpr std::array domain_names{"on the echo", "speckle", "on the field", "on the image"};

template <template <typename> class Stage>
void read_parameters(Reader& reader, Stage<Distribution>& stage) {
  for (const auto& p : Stage<Distribution>::parameters()) {
    stage.*p.member = p.otherwise ? read_distribution_or(reader, p.name, *p.otherwise, p.limits)
                                  : read_distribution(reader, p.name, p.limits);
  }
}

template <std::size_t... Kinds>
NoiseStage<Distribution> read_stage(Reader& reader, std::index_sequence<Kinds...>) {
  using Any = NoiseStage<Distribution>;
  const std::string kind = reader.choice("stage", {std::variant_alternative_t<Kinds, Any>::kind...});
  Any stage;
  const auto read_if_named = [&]<typename Stage>(Stage) {
    if (kind != Stage::kind) return;
    stage = Stage{};
    read_parameters(reader, std::get<Stage>(stage));
  };
  (read_if_named(std::variant_alternative_t<Kinds, Any>{}), ...);
  return stage;
}

template <template <typename> class Stage, typename Draw>
NoiseStage<double> draw_parameters(const Stage<Distribution>& stage, const Draw& draw) {
  Stage<double> drawn{};
  constexpr auto from = Stage<Distribution>::parameters();
  constexpr auto to = Stage<double>::parameters();
  for (std::size_t i = 0; i < from.size(); ++i) drawn.*to[i].member = draw(from[i].name, stage.*from[i].member);
  return drawn;
}

double largest(const Distribution& distribution) {
  struct {
    double operator()(const Constant& d) const { return d.value; }
    double operator()(const Uniform& d) const { return d.high; }
    double operator()(const LogUniform& d) const { return d.high; }
    double operator()(const Normal& d) const { return d.mean + 3.0 * d.sigma; }
    double operator()(const Choice& d) const { return *std::max_element(d.values.begin(), d.values.end()); }
  } visitor;
  return std::visit(visitor, distribution);
}

void check_order(const Reader& reader, const std::vector<NoiseStage<Distribution>>& stages) {
  if (stages.size() < 2) return;
  const NoiseDomain before = domain_of(stages[stages.size() - 2]);
  const NoiseDomain now = domain_of(stages.back());
  if (before == NoiseDomain::speckle && now == NoiseDomain::speckle) {
    reader.fail("stage",
                "a profile has one speckle stage: coherent_speckle, rayleigh_speckle, gamma_speckle, k_speckle");
  }
  if (now < before) {
    reader.fail("stage", fmt::format("a stage {} can not follow one {}; the order is: on the echo, speckle, on the "
                                     "field, on the image",
                                     domain_names[static_cast<std::size_t>(now)],
                                     domain_names[static_cast<std::size_t>(before)]));
  }
}

}  // namespace

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
template std::vector<std::string> stage_names(const std::vector<NoiseStage<double>>&);
template std::vector<std::string> stage_names(const std::vector<NoiseStage<Distribution>>&);

bool NoiseChain::acts_before_image() const {
  return std::any_of(stages.begin(), stages.end(), [](const auto& s) { return domain_of(s) < NoiseDomain::image; });
}

NoiseProfile load_noise(const ConfigSource& source) {
  Reader file = open_config("noise", source);
  NoiseProfile profile;
  profile.name = file.text("name");
  for (Reader& stage : file.children("stages")) {
    profile.stages.push_back(
        read_stage(stage, std::make_index_sequence<std::variant_size_v<NoiseStage<Distribution>>>{}));
    stage.finish();
    check_order(stage, profile.stages);
  }
  if (profile.stages.size() > max_stages) file.fail("stages", fmt::format("at most {} stages", max_stages));
  file.finish();
  return profile;
}

void check_noise(const NoiseProfile& profile, const SonarModel& sonar) {
  const int beams = sonar.geometry.beams();
  const auto must_fit = [&](const char* kind, const char* parameter, const Distribution& width) {
    if (largest(width) < beams) return;
    throw ConfigError(
        fmt::format("noise {}: {}: {} reaches {:g}, which is wider than the fan of {} ({} beams); it must "
                    "be less than the number of beams",
                    profile.name, kind, parameter, largest(width), sonar.name, beams));
  };
  for (const auto& stage : profile.stages) {
    if (const auto* s = std::get_if<CrossTalk<Distribution>>(&stage))
      must_fit(s->kind, "period_beams", s->period_beams);
    if (const auto* s = std::get_if<CentreStripe<Distribution>>(&stage))
      must_fit(s->kind, "width_beams", s->width_beams);
  }
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
    std::visit([&](const auto& stage) { chain.stages.push_back(draw_parameters(stage, draw)); }, profile.stages[i]);
  }
  return chain;
}

}  // namespace ensonify
