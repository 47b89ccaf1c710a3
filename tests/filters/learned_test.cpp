#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/filters/learned_model.hpp"
#include "ensonify/output/grey_file.hpp"
#include "support/test_folders.hpp"

/// Networks of tests/filters/learned/make_goldens.py.
namespace ensonify {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

fs::path goldens() { return source_folder() / "tests/filters/learned"; }

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <typename Fault, typename Call>
std::string fault_of(const Call& call) {
  try {
    call();
  } catch (const Fault& e) {
    return e.what();
  }
  return "no fault";
}

class Learned : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() /
             (std::string("ensonify_learned_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder);
    for (const char* file : {"unet.onnx", "unet.json", "pix2pix.onnx", "pix2pix.json"}) {
      fs::copy_file(goldens() / file, folder / file, fs::copy_options::overwrite_existing);
    }
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const char* name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
  FilterStep step(const std::string& method, const std::string& model) const {
    FilterStep made = make_filter(method);
    assign_parameter(made, "model=" + (folder / model).string());
    return made;
  }
  std::string data_fault() const {
    return fault_of<DataError>([&] { LearnedModel model(folder / "unet.onnx"); });
  }

  fs::path folder;
};

Image2<float> noise(int rows, int columns, std::uint64_t seed = 1) {
  const RandomKey key = RandomKey::from_seed(seed).child("learned_test");
  Image2<float> image(rows, columns);
  std::uint64_t at = 0;
  for (float& pixel : image.pixels()) pixel = static_cast<float>(255.0 * uniform_at(key, at++));
  return image;
}

TEST_F(Learned, ProbabilitiesAreTorchs) {
  const Image2<float> image = read_grey(goldens() / "image.npy").grey;
  for (const char* network : {"unet", "pix2pix"}) {
    const LearnedModel model(folder / (std::string(network) + ".onnx"));
    const Image2<float> ours = model.probability(image);
    const Image2<float> theirs = read_grey(goldens() / (std::string(network) + "_probability.npy")).grey;
    ASSERT_EQ(ours.size(), theirs.size());
    float largest = 0, low = 1, high = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      largest = std::max(largest, std::abs(ours.pixels()[i] - theirs.pixels()[i]));
      low = std::min(low, theirs.pixels()[i]);
      high = std::max(high, theirs.pixels()[i]);
    }
    EXPECT_LT(largest, 1e-4F) << network;
    EXPECT_GT(high - low, 0.3F) << network << ": too even an output shows little";
  }
}

TEST_F(Learned, MasksAreWhereTheProbabilityReachesTheThreshold) {
  const GreyImage image = read_grey(goldens() / "image.npy");
  const Image2<float> probability = LearnedModel(folder / "unet.onnx").probability(image.grey);
  for (const char* threshold : {"", "0.3"}) {
    FilterStep unet = step("unet", "unet.onnx");
    if (*threshold) assign_parameter(unet, std::string("threshold=") + threshold);
    const Image2<float> mask = apply({"test", {unet}}, image).grey;
    const double least = *threshold ? 0.3 : 0.5;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      EXPECT_EQ(mask.pixels()[i], probability.pixels()[i] >= least ? 255.0F : 0.0F);
    }
  }
}

TEST_F(Learned, AnySizeAndDepthWorks) {
  const FilterStep unet = step("unet", "unet.onnx");
  for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 300}, {300, 1}, {64, 64}, {65, 63}, {703, 256}}) {
    const GreyImage out = apply({"test", {unet}}, {noise(rows, columns), GreyDepth::real});
    EXPECT_EQ(out.grey.rows(), rows);
    EXPECT_EQ(out.grey.columns(), columns);
  }
  Image2<std::uint8_t> eight(40, 30);
  Image2<std::uint16_t> sixteen(40, 30);
  for (std::size_t i = 0; i < eight.size(); ++i) {
    eight.pixels()[i] = static_cast<std::uint8_t>(i * 7 % 256);
    sixteen.pixels()[i] = static_cast<std::uint16_t>(eight.pixels()[i] * 257);
  }
  const LearnedModel model(folder / "unet.onnx");
  EXPECT_EQ(model.probability(to_grey(eight).grey), model.probability(to_grey(sixteen).grey));
}

TEST_F(Learned, TheBitsDoNotDependOnTheNumberOfThreads) {
  constexpr int count = 12;
  std::vector<Image2<float>> images, expected;
  for (int i = 0; i < count; ++i) images.push_back(noise(150 + 31 * (i % 3), 130 + 17 * (i % 4), i));
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    cv::setNumThreads(static_cast<int>(threads));  // into so many parts OpenCV cuts its work
    const LearnedModel model(folder / "pix2pix.onnx");
    std::vector<Image2<float>> results(count);
    parallel_for(count, [&](int i) { results[i] = model.probability(images[i]); });
    if (expected.empty()) expected = results;
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(results[i], expected[i]) << threads << " threads";
      EXPECT_EQ(model.probability(images[i]), expected[i]) << "alone, " << threads << " threads";
    }
  }
  cv::setNumThreads(-1);
}

TEST_F(Learned, AModelThatIsCutShortIsAnError) {
  const std::string whole = bytes_of(folder / "unet.onnx");
  for (std::size_t length = 0; length < whole.size(); length += length < 2000 ? 13 : 997) {
    write("unet.onnx", whole.substr(0, length));
    EXPECT_THAT(data_fault(), AllOf(HasSubstr("unet.onnx"), HasSubstr("that ensonify can run"))) << length;
  }
}

/// Whatever the bytes: an error, or a network that runs.
TEST_F(Learned, BrokenBytesNeverCrash) {
  const std::string whole = bytes_of(folder / "unet.onnx");
  const RandomKey key = RandomKey::from_seed(3).child("bytes");
  const Image2<float> image = noise(64, 64);
  int refused = 0;
  for (std::uint64_t n = 0; n < 1500; ++n) {
    std::string bytes = whole;
    // Half of the changes hit the first bytes, where the graph is; weights fill the rest.
    const double reach = n % 2 == 0 ? 6000.0 : static_cast<double>(whole.size());
    for (std::uint64_t i = 0; i <= n % 3; ++i) {
      const auto at = static_cast<std::size_t>(reach * uniform_at(key, 16 * n + 2 * i));
      bytes[at] = static_cast<char>(256.0 * uniform_at(key, 16 * n + 2 * i + 1));
    }
    write("unet.onnx", bytes);
    try {
      LearnedModel(folder / "unet.onnx").probability(image);
    } catch (const DataError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

TEST_F(Learned, FaultsNameTheFileAndTheCure) {
  const auto method_fault = [&](const FilterStep& made) { return fault_of<ConfigError>([&] { check_filter(made); }); };
  EXPECT_THAT(method_fault(make_filter("unet")),
              AllOf(HasSubstr("unet: model must be given"), HasSubstr("docs/learned_filter.md")));
  EXPECT_THAT(method_fault(step("unet", "absent.onnx")), AllOf(HasSubstr("absent.onnx"), HasSubstr("no such file")));
  EXPECT_THAT(method_fault(step("unet", "pix2pix.onnx")), HasSubstr("is a pix2pix network"));
  EXPECT_THAT(fault_of<ConfigError>([] {
                FilterStep unet = make_filter("unet");
                assign_parameter(unet, "threshold=2");
              }),
              HasSubstr("a number from 0 to 1"));

  const std::string card = bytes_of(folder / "unet.json");
  write("unet.json", "{\"schema\": 1");
  EXPECT_THAT(data_fault(), HasSubstr("unet.json"));
  write("unet.json", "{\"schema\": 2}");
  EXPECT_THAT(data_fault(), AllOf(HasSubstr("unet.json:1"), HasSubstr("schema")));
  write("unet.json", "{\"schemer\": 1, " + card.substr(1));
  EXPECT_THAT(data_fault(), HasSubstr("schemer"));
  fs::remove(folder / "unet.json");
  EXPECT_THAT(data_fault(), AllOf(HasSubstr("unet.json"), HasSubstr("the card")));
  write("unet.onnx", "\x89PNG\r\n not a model");
  EXPECT_THAT(data_fault(), HasSubstr("no ONNX model"));
}

TEST_F(Learned, AChainFindsItsModelBesideIt) {
  write("chain.yaml", "name: mine\nsteps:\n  - {method: unet, model: unet.onnx, threshold: 0.4}\n  - {method: mask}\n");
  const FilterChain chain = load_filter_chain((folder / "chain.yaml").string());
  EXPECT_EQ(apply(chain, read_grey(goldens() / "image.npy")).grey.rows(), 70);
}

}  // namespace
}  // namespace ensonify
