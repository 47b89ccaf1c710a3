#include "ensonify/filters/filter_chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "ensonify/core/error.hpp"
#include "ensonify/filters/filter_registry.hpp"

namespace ensonify {
namespace {

using testing::HasSubstr;

std::string written(const std::string& yaml) {
  const auto path =
      std::filesystem::temp_directory_path() /
      (std::string("ensonify_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml");
  std::ofstream(path) << yaml;
  return path.string();
}

template <typename Fault = ConfigError, typename Call>
std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const Fault& e) {
    return e.what();
  }
  return "no fault";
}

GreyImage ramp() {
  GreyImage image{Image2<float>(16, 16), GreyDepth::real};
  for (int i = 0; i < 256; ++i) image.grey.pixels()[static_cast<std::size_t>(i)] = static_cast<float>(i);
  return image;
}

TEST(FilterChain, StepsActInTheirOrderAndMaskKeepsTheRawImage) {
  const FilterChain chain =
      load_filter_chain(written("name: test\nsteps:\n  - {method: threshold, t: 100}\n  - {method: mask}\n"));
  const GreyImage raw = ramp();
  const GreyImage out = apply(chain, raw);
  for (int i = 0; i < 256; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(out.grey.pixels()[at], i >= 100 ? raw.grey.pixels()[at] : 0.0F);
  }
}

TEST(FilterChain, BundledChainsAndPresetsLoad) {
  EXPECT_EQ(load_filter_chain("post_processing").steps.size(), 2U);
  EXPECT_FALSE(load_filter_preset("paper").methods.empty());
  EXPECT_FALSE(load_filter_preset("tuned").methods.empty());
}

/// The preset `paper` is a list for readers: the defaults are the paper's.
TEST(FilterChain, ThePapersParametersAreTheDefaults) {
  for (const auto& [name, step] : load_filter_preset("paper").methods) {
    const auto chosen = parameter_values(step), defaults = parameter_values(make_filter(name));
    for (const auto& value : defaults) EXPECT_THAT(chosen, testing::Contains(value)) << name;
  }
  EXPECT_EQ(parameter_values(load_filter_preset("paper").methods.at("lee_enhanced")),
            (std::vector<std::pair<std::string, std::string>>{{"variant", "published"},
                                                              {"window", "5"},
                                                              {"k", "1"},
                                                              {"cu", "0.25"},
                                                              {"cmax", "1.73"},
                                                              {"domain", "linear"}}));
}

TEST(FilterChain, FaultsNameThePlaceTheRuleAndTheNearest) {
  const auto chain_fault = [](const std::string& step) {
    return fault_of([&] { load_filter_chain(written("name: test\nsteps:\n  - " + step + "\n")); });
  };
  EXPECT_THAT(chain_fault("{method: wavlet}"), testing::AllOf(HasSubstr(":3"), HasSubstr("did you mean 'wavelet'?")));
  EXPECT_THAT(chain_fault("{method: lee, windw: 5}"),
              testing::AllOf(HasSubstr(":3"), HasSubstr("did you mean 'window'?")));
  EXPECT_THAT(chain_fault("{method: lee, window: 4}"),
              HasSubstr("window must be an odd number from 3 to 101, not '4'"));
  EXPECT_THAT(chain_fault("{method: anisodiff, kappa: -1}"), HasSubstr("kappa must be a number from"));
  EXPECT_THAT(chain_fault("{method: anisodiff, gamma: 0.4}"), HasSubstr("unstable"));
  EXPECT_THAT(chain_fault("{method: lee_enhanced, cmax: 0.2}"), HasSubstr("must be above cu"));
  EXPECT_THAT(chain_fault("{method: cfar, rule: xx}"), HasSubstr("ca or soca or goca or os"));
  EXPECT_THAT(chain_fault("{method: srad, dt: .nan}"), HasSubstr("dt must be a number"));
  EXPECT_THAT(fault_of([] { load_filter_chain(written("name: test\nsteps: []\n")); }), HasSubstr("1 to 32 steps"));
  EXPECT_THAT(fault_of([] { load_filter_chain(written("name: test\nstepz: []\n")); }), HasSubstr("steps"));
}

TEST(FilterChain, APixelThatIsNoNumberIsNamed) {
  GreyImage image = ramp();
  image.grey(3, 7) = std::numeric_limits<float>::quiet_NaN();
  const FilterChain chain{"test", {make_filter("lee")}};
  EXPECT_THAT(fault_of<DataError>([&] { apply(chain, image); }), HasSubstr("row 3, column 7 is nan"));
  image.grey(3, 7) = std::numeric_limits<float>::infinity();
  EXPECT_THAT(fault_of<DataError>([&] { apply(chain, image); }), HasSubstr("row 3, column 7 is inf"));
}

TEST(FilterRegistry, EveryParameterCanBeSetToWhatItsListSays) {
  for (const MethodInfo& method : filter_methods()) {
    FilterStep step = make_filter(method.name);
    for (const auto& [key, value] : parameter_values(step)) {
      EXPECT_EQ(set_parameter(step, key, value), "") << method.name << " " << key;
    }
    EXPECT_EQ(parameter_values(step), parameter_values(make_filter(method.name)));
    if (method.ready) {
      EXPECT_NO_THROW(check_filter(step));
    }
  }
}

/// The paper's order: mask, masked raw image, unsharp; before a map not sharpened twice.
TEST(FilterChain, LearnedChainsAreThePapersAndAreSharpenedOnce) {
  for (const char* name : {"learned", "learned_paper"}) {
    const auto methods = [](const FilterChain& chain) {
      std::vector<std::string> names;
      for (const FilterStep& step : chain.steps) names.emplace_back(name_of(step.method));
      return names;
    };
    const FilterChain chain = find_filter(name);
    EXPECT_EQ(methods(chain), (std::vector<std::string>{"unet", "mask", "unsharp"})) << name;
    EXPECT_EQ(methods(chain_for_maps(chain, true)), (std::vector<std::string>{"unet", "mask", "unsharp", "equalize"}));
  }
  EXPECT_EQ(chain_for_maps(find_filter("lee"), true).steps.size(), 3u);  // lee, unsharp, equalize
}

/// A step from 50 to 150: both sides of the edge move away from each other by the same.
TEST(Finishing, UnsharpRaisesEdgesAndKeepsTheScale) {
  GreyImage image{Image2<float>(9, 40, 50.0F), GreyDepth::real};
  for (int i = 0; i < 9; ++i) {
    for (int j = 20; j < 40; ++j) image.grey(i, j) = 150.0F;
  }
  const Image2<float> out = apply({"test", {make_filter("unsharp")}}, image).grey;
  EXPECT_FLOAT_EQ(out(4, 5), 50.0F);
  EXPECT_LT(out(4, 19), 30.0F);
  EXPECT_GT(out(4, 20), 170.0F);
  EXPECT_NEAR(out(4, 19) + out(4, 20), 200.0F, 1e-3F);
}

/// Half the pixels 10, half 20: the cumulative histogram takes them to 0 and 255.
TEST(Finishing, EqualizeSpreadsTheLevels) {
  GreyImage image{Image2<float>(8, 8, 10.0F), GreyDepth::real};
  for (int j = 0; j < 8; ++j) {
    for (int i = 0; i < 4; ++i) image.grey(i, j) = 20.0F;
  }
  const Image2<float> out = apply({"test", {make_filter("equalize")}}, image).grey;
  EXPECT_EQ(out(0, 0), 255.0F);
  EXPECT_EQ(out(7, 0), 0.0F);
}

}  // namespace
}  // namespace ensonify
