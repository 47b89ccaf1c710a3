#include "ensonify/config/reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The message of the ConfigError that `use` throws on this text; empty where it throws none.
std::string refusal(const std::string& yaml, const std::function<void(Reader&)>& use) {
  try {
    Reader reader = Reader::from_text(yaml, "t.yaml");
    use(reader);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

const std::function<void(Reader&)> nothing = [](Reader&) {};

TEST(Reader, UnknownKeyNamesPlaceAndNearest) {
  const auto use = [](Reader& r) {
    r.number("range_max_m");
    r.number_or("gain_db", 0);
    r.finish();
  };
  EXPECT_EQ(refusal("range_max_m: 5\n\ngain_bd: 3\n", use), "t.yaml:3: gain_bd: unknown key; did you mean 'gain_db'?");
  const std::string far = refusal("range_max_m: 5\nzzzzzzzzzzzz: 3\n", use);
  EXPECT_THAT(far, StartsWith("t.yaml:2: zzzzzzzzzzzz: unknown key; valid are "));
  EXPECT_THAT(far, HasSubstr("gain_db"));
  EXPECT_EQ(refusal("range_max_m: 5\n", use), "");
}

TEST(Reader, MissingKey) {
  const auto use = [](Reader& r) { r.number("range_max_m"); };
  EXPECT_THAT(refusal("a: 1\n", use), HasSubstr("needs the key 'range_max_m'"));
  EXPECT_EQ(refusal("a: 1\nrange_max: 5\n", use),
            "t.yaml:2: range_max: did you mean 'range_max_m', which is missing here?");
  EXPECT_THAT(refusal("range_max_m:\n", use), HasSubstr("needs the key"));  // null is no value
}

// Keys that are read after the missing one are not unknown.
TEST(Reader, MissingKeyAccusesNoOther) {
  const auto sonar = [](Reader& r) {
    r.text("name");
    r.child("beams");
  };
  EXPECT_EQ(refusal("beams: {}\n", sonar), "t.yaml:1: needs the key 'name'");
  const auto window = [](Reader& r) {
    r.number("min_m");
    r.number("max_m");
  };
  EXPECT_EQ(refusal("max_m: 3\n", window), "t.yaml:1: needs the key 'min_m'");
  EXPECT_EQ(refusal("y_m: 3\n", [](Reader& r) { r.number("x_m"); }), "t.yaml:1: needs the key 'x_m'");
}

TEST(NearestWord, NamesWhatIsMeantAndNothingElse) {
  const std::vector<std::string> filters{"lee", "kuan", "frost", "median", "wavelet"};
  EXPECT_EQ(nearest_word("none", filters), "");
  EXPECT_EQ(nearest_word("le", filters), "lee");
  EXPECT_EQ(nearest_word("wavlet", filters), "wavelet");
  EXPECT_EQ(nearest_word("mediam", filters), "median");
  EXPECT_EQ(nearest_word("xyz", filters), "");
  EXPECT_EQ(nearest_word("training", {"test", "train", "val"}), "train");
  EXPECT_EQ(nearest_word("holo", {"holoocean", "oculus_m370s"}), "holoocean");
}

TEST(Reader, NestedPlaces) {
  const auto use = [](Reader& r) {
    Reader child = r.child("receive");
    child.number("gamma", {0.05, 4.0});
  };
  EXPECT_EQ(refusal("name: x\nreceive:\n  gamma: 9\n", use), "t.yaml:3: receive.gamma: must lie in [0.05, 4], not 9");
  const auto list = [](Reader& r) {
    for (Reader& entry : r.children("stages")) entry.number("sigma", positive);
  };
  EXPECT_EQ(refusal("stages:\n  - sigma: 1\n  - sigma: -1\n", list),
            "t.yaml:3: stages[1].sigma: must be above 0, not -1");
  EXPECT_THAT(refusal("stages: 5\n", list), StartsWith("t.yaml:1: stages: must be a list"));
  EXPECT_THAT(refusal("stages: [5]\n", list), StartsWith("t.yaml:1: stages: entry 0 must be a mapping"));
  EXPECT_THAT(refusal("receive: [1]\n", use), StartsWith("t.yaml:1: receive: must be a mapping"));
}

TEST(Reader, DuplicateKey) { EXPECT_THAT(refusal("a: 1\nb: 2\na: 3\n", nothing), HasSubstr("a: is given twice")); }

TEST(Reader, WrongTypes) {
  const auto number = [](Reader& r) { r.number("a"); };
  for (const char* text : {"a: 5 m", "a: five", "a: [1]", "a: {b: 1}", "a: true", "a: 1,5", "a: ''"}) {
    EXPECT_THAT(refusal(text, number), StartsWith("t.yaml:1: a: must be a plain number")) << text;
  }
  for (const char* text : {"a: .nan", "a: .inf", "a: -.inf"}) {
    EXPECT_THAT(refusal(text, number), HasSubstr("must be a finite number")) << text;
  }
  const auto integer = [](Reader& r) { r.integer("a", 1, 10); };
  for (const char* text : {"a: 1.5", "a: 0", "a: 11", "a: 1e30"}) {
    EXPECT_THAT(refusal(text, integer), HasSubstr("whole number in [1, 10]")) << text;
  }
  EXPECT_EQ(refusal("a: 10", integer), "");
  EXPECT_THAT(refusal("a: perhaps", [](Reader& r) { r.boolean_or("a", false); }), HasSubstr("true or false"));
  EXPECT_THAT(refusal("a: x", [](Reader& r) { r.choice("a", {"one", "two"}); }), HasSubstr("one of one, two, not 'x'"));
  for (const char* text : {"a: [1, 2]", "a: 3", "a: [1, 2, x]", "a: [1, 2, .nan]"}) {
    EXPECT_THAT(refusal(text, [](Reader& r) { r.vec3("a"); }), HasSubstr("a list of 3 numbers")) << text;
  }
}

TEST(Reader, LimitsSayTheRule) {
  EXPECT_THAT(refusal("a: 0", [](Reader& r) { r.number("a", positive); }), HasSubstr("must be above 0, not 0"));
  EXPECT_THAT(refusal("a: -1", [](Reader& r) { r.number("a", not_negative); }), HasSubstr("must not be negative"));
  EXPECT_EQ(refusal("a: 0", [](Reader& r) { r.number("a", not_negative); }), "");
  EXPECT_EQ(refusal("a: 4", [](Reader& r) { r.number("a", {1, 4}); }), "");  // ends included
  EXPECT_NEAR(Reader::from_text("a_deg: 180", "t").angle_deg("a_deg"), 3.14159265358979, 1e-12);
}

// A document that is no mapping must still say where and what.
TEST(Reader, TopLevelIsNoMapping) {
  for (const char* text : {"- a\n- b\n", "[1, 2]", "just words", "5", "- {a: 1}\n"}) {
    EXPECT_EQ(refusal(text, nothing), "t.yaml:1: must be a mapping of keys to values") << text;
  }
  EXPECT_THAT(refusal("", nothing), StartsWith("t.yaml:"));
  EXPECT_THAT(refusal("", nothing), HasSubstr("must be a mapping"));
  EXPECT_THAT(refusal("# only a comment\n", nothing), HasSubstr("must be a mapping"));
}

TEST(Reader, BrokenYamlNamesTheLine) {
  EXPECT_THAT(refusal("a: 1\nb: [1, 2\nc: 3\n", nothing), HasSubstr("no valid YAML"));
  EXPECT_THAT(refusal("a: 1\n\tb: 2\n", nothing), StartsWith("t.yaml:2: no valid YAML"));
  EXPECT_THAT(refusal("? [a, b]\n: 1\n", nothing), HasSubstr("keys must be plain words"));
  EXPECT_THAT(refusal("a: *nowhere\n", nothing), HasSubstr("no valid YAML"));
  EXPECT_THAT(refusal(std::string("a: \0b", 5), nothing), testing::Not(HasSubstr("Segmentation")));
  EXPECT_NE(refusal(std::string(100'000, '['), nothing), "");  // deep nesting must not eat the stack
  EXPECT_NE(refusal(std::string(100'000, '{'), nothing), "");
}

TEST(Reader, Files) {
  const auto folder = std::filesystem::temp_directory_path() / "ensonify_reader_test";
  std::filesystem::create_directories(folder);
  EXPECT_THROW(Reader::from_file(folder / "missing.yaml"), ConfigError);
  EXPECT_THROW(Reader::from_file(folder), ConfigError);
  std::ofstream(folder / "huge.yaml") << "a: 1\n#" << std::string(5u << 20, 'x');
  try {
    Reader::from_file(folder / "huge.yaml");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), HasSubstr("larger than 4 MiB"));
  }
  std::ofstream(folder / "good.yaml") << "a: 1\n";
  Reader good = Reader::from_file(folder / "good.yaml");
  EXPECT_EQ(good.number("a"), 1.0);
  EXPECT_EQ(good.folder(), folder);
  std::filesystem::remove_all(folder);
}

TEST(NearestWord, Distances) {
  EXPECT_EQ(nearest_word("rnage", {"range", "gain"}), "range");
  EXPECT_EQ(nearest_word("oculus", {"holoocean", "oculus_m1200d_hf"}), "oculus_m1200d_hf");
  EXPECT_EQ(nearest_word("qqqqqqqq", {"range", "gain"}), "");
  EXPECT_EQ(nearest_word("x", {}), "");
}

}  // namespace
}  // namespace ensonify
