#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "ensonify/core/error.hpp"
#include "ensonify/core/parallel.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/filters/activation.hpp"
#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/filters/learned_model.hpp"
#include "ensonify/filters/network.hpp"
#include "ensonify/output/grey_file.hpp"
#include "ensonify/output/sha256.hpp"
#include "support/network_maker.hpp"
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
    for (const char* file : {"unet.onnx", "unet.json", "pix2pix.onnx", "pix2pix.json", "two_heads.onnx",
                             "two_heads.json", "odd_kernels.onnx", "odd_kernels.json"}) {
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

void expect_torchs(const Image2<float>& ours, const std::string& golden) {
  const Image2<float> theirs = read_grey(goldens() / (golden + ".npy")).grey;
  ASSERT_EQ(ours.size(), theirs.size());
  float largest = 0, low = 1, high = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    largest = std::max(largest, std::abs(ours.pixels()[i] - theirs.pixels()[i]));
    low = std::min(low, theirs.pixels()[i]);
    high = std::max(high, theirs.pixels()[i]);
  }
  EXPECT_LT(largest, 1e-4F) << golden;
  EXPECT_GT(high - low, 0.3F) << golden << ": too even an output shows little";
}

TEST_F(Learned, ProbabilitiesAndCleanImagesAreTorchs) {
  const Image2<float> image = read_grey(goldens() / "image.npy").grey;
  for (const std::string network : {"unet", "pix2pix", "two_heads", "odd_kernels"}) {
    const LearnedModel model(folder / (network + ".onnx"));
    const LearnedOutput output = model.outputs(image);
    expect_torchs(output.probability, network + "_probability");
    ASSERT_EQ(output.clean.has_value(), network == "two_heads" || network == "odd_kernels");
    ASSERT_EQ(model.cleans(), output.clean.has_value());
    if (output.clean) expect_torchs(*output.clean, network + "_clean");
  }
}

TEST_F(Learned, TheCleanImageIsInGreyLevels) {
  const GreyImage image = read_grey(goldens() / "image.npy");
  const Image2<float> share = LearnedModel(folder / "two_heads.onnx").outputs(image.grey).clean.value();
  const Image2<float> grey = apply({"test", {step("unet_clean", "two_heads.onnx")}}, image).grey;
  for (std::size_t i = 0; i < grey.size(); ++i) EXPECT_EQ(grey.pixels()[i], 255.0F * share.pixels()[i]);
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
  FilterStep unet = step("unet", "unet.onnx");
  assign_parameter(unet, "output=probability");
  const Image2<float> levels = apply({"test", {unet}}, image).grey;
  for (std::size_t i = 0; i < levels.size(); ++i) EXPECT_EQ(levels.pixels()[i], 255.0F * probability.pixels()[i]);
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
    const LearnedModel model(folder / "pix2pix.onnx");
    std::vector<Image2<float>> results(count);
    parallel_for(count, [&](int i) { results[i] = model.probability(images[i]); });
    if (expected.empty()) expected = results;
    for (int i = 0; i < count; ++i) {
      EXPECT_EQ(results[i], expected[i]) << threads << " threads";
      EXPECT_EQ(model.probability(images[i]), expected[i]) << "alone, " << threads << " threads";
    }
  }
}

/// Wide networks, whose layers are cut into many tasks, and images of several sizes in turn.
TEST_F(Learned, WideNetworksGiveTheSameBitsTooWhateverCameBefore) {
  const OnnxFile file = random_unet(16, 6, 2);
  const std::vector<Image2<float>> images{noise(64, 64), noise(704, 256), noise(128, 192), noise(256, 64),
                                          noise(64, 64)};
  std::vector<std::vector<Image2<float>>> expected;
  for (const Image2<float>& image : images) expected.push_back(Network(file).run(image));
  EXPECT_EQ(expected.front(), expected.back());
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const Network network(file);
    for (std::size_t i = 0; i < images.size(); ++i) EXPECT_EQ(network.run(images[i]), expected[i]) << threads;
    parallel_for(20, [&](int i) { EXPECT_EQ(network.run(images[i % 5]), expected[i % 5]) << threads; });
    std::vector<std::thread> others;  // of no pool
    for (int i = 0; i < 4; ++i) others.emplace_back([&, i] { EXPECT_EQ(network.run(images[i]), expected[i]); });
    for (std::thread& other : others) other.join();
  }
}

/// What is planned is what the nodes say: numbers by hand.
TEST_F(Learned, OneConvolutionAndItsTransposeAreSumsOfProducts) {
  NetworkMaker maker;
  const OnnxFile down_up = maker.end(maker.transpose(maker.activate("LeakyRelu", maker.conv("image", 1, 2, 4)), 2, 1));
  const Image2<float> image = noise(6, 8);
  Image2<float> scaled = image;
  for (float& x : scaled.pixels()) x /= 255.0F;
  const auto& tensors = down_up.tensors;
  const auto at = [](const OnnxTensor& t, int a, int b, int row, int column) {
    return t.values[((a * t.shape[1] + b) * t.shape[2] + row) * t.shape[3] + column];
  };
  Image2<float> expected(6, 8, tensors.at("t3").values[0]);
  for (int c = 0; c < 2; ++c) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 4; ++x) {
        float sum = tensors.at("t1").values[c];
        const auto cells = [&](const auto& visit) {
          for (int k = 0; k < 16; ++k) {
            const int row = 2 * y - 1 + k / 4, column = 2 * x - 1 + k % 4;
            if (row >= 0 && row < 6 && column >= 0 && column < 8) visit(row, column, k / 4, k % 4);
          }
        };
        cells(
            [&](int i, int j, int row, int column) { sum += scaled(i, j) * at(tensors.at("t0"), c, 0, row, column); });
        sum = sum > 0 ? sum : 0.2F * sum;
        cells([&](int i, int j, int row, int column) {
          expected(i, j) += sum * at(tensors.at("t2"), c, 0, row, column);
        });
      }
    }
  }
  const Image2<float> ours = Network(down_up).run(scaled).front();
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_NEAR(ours.pixels()[i], 1 / (1 + std::exp(-expected.pixels()[i])), 1e-5) << i;
  }
}

TEST(Activations, SigmoidIsRightAndHoldsItsEnds) {
  std::vector<float> numbers{-INFINITY, -1e30F, -100, 0, 100, 1e30F, INFINITY};
  for (int i = -2000; i <= 2000; ++i) numbers.push_back(0.01F * static_cast<float>(i));
  std::vector<float> results = numbers;
  activate({Sigmoid{}}, results);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_NEAR(results[i], 1 / (1 + std::exp(-static_cast<double>(numbers[i]))), 3e-7) << numbers[i];
  }
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
  EXPECT_THAT(method_fault(make_filter("pix2pix")),
              AllOf(HasSubstr("pix2pix: model must be given"), HasSubstr("docs/learned_filter.md")));
  EXPECT_THAT(method_fault(step("unet", "absent.onnx")), AllOf(HasSubstr("absent.onnx"), HasSubstr("no such file")));
  EXPECT_THAT(method_fault(step("unet_clean", "unet.onnx")),
              AllOf(HasSubstr("unet_clean"), HasSubstr("gives no clean image")));
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

/// Each bundled model gives what its card says; one of them is the default.
TEST(BundledModels, AreWholeAndOneIsUsual) {
  for (const char* name : {"paper", "realistic"}) {
    for (const char* method : {"unet", "unet_clean"}) {
      FilterStep step = make_filter(method);
      assign_parameter(step, std::string("model=") + name);
      EXPECT_NO_THROW(check_filter(step)) << name << " " << method;
    }
    const fs::path file = source_folder() / "filters/models/library" / (std::string(name) + ".onnx");
    EXPECT_LE(fs::file_size(file), 8u << 20U);
    EXPECT_THAT(bytes_of(fs::path(file).replace_extension(".json")), HasSubstr(sha256_of_file(file)));
  }
  EXPECT_NO_THROW(check_filter(make_filter("unet")));
}

}  // namespace
}  // namespace ensonify
